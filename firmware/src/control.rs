//! The control task: a frame in, a motor drive out, every 0.5 ms. It waits for nothing but the next frame.
//! Runs in its own executor (2). Owns bridge, board, watchdog and all of the logic. Never panics, waits, or touches flash and line.

use embassy_stm32::peripherals::IWDG;
use embassy_stm32::wdg::IndependentWatchdog;
use tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME;
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::{MotorBridge, MotorDrive};
use tenax_hal_shim::schedule::{Job, select_of_slot, slot_of};
use tenax_hal_shim::wire::{Down, FRAMES_PER_RAW, Received, Refusal};
use tenax_logic::device::Device;
use tenax_logic::fingertip::Fingertip;
use tenax_logic::stream::SENSES_SLOT;

use crate::black_box;
use crate::board::{Button, Switches, Vibrator};
use crate::bridge::Bridge;
use crate::counts;
use crate::last_words;
use crate::mail;
use crate::scan::Scan;
use crate::timing::LIVED_WELL;

pub struct Control {
    pub device: Device,
    bridge: Bridge,
    vibrator: Vibrator,
    switches: Switches,
    button: Button,
    watchdog: IndependentWatchdog<'static, IWDG>,
    slow_frames: u16,
}

impl Control {
    pub fn new(
        (bridge, vibrator): (Bridge, Vibrator),
        switches: Switches,
        button: Button,
        watchdog: IndependentWatchdog<'static, IWDG>,
    ) -> Self {
        Self { device: Device::default(), bridge, vibrator, switches, button, watchdog, slow_frames: 0 }
    }

    /// Everything that a frame causes, the most urgent first.
    fn on_frame(&mut self, frame: &Frame) {
        let next = frame.sequence.wrapping_add(1);
        self.switches.show(select_of_slot((next % u32::from(FRAMES_PER_SLOW_FRAME)) as u8));

        self.device.fingertip.button(self.button.is_down());
        if has_room_for_command(frame) {
            self.take_command();
        }
        let drive = tenax_control_tick(&mut self.device.fingertip, frame);
        self.bridge.drive(drive);
        self.watchdog.pet();
        counts::TICKS.add_one();

        self.device.sampled(frame);
        if self.device.has_message() {
            self.tell();
        }
        if frame.slot() == slot_of(Job::Save) {
            self.save();
        }
        mail::end_tick();
    }

    /// Not inlined: few ticks have something to tell, and each message is a copy on the stack.
    #[inline(never)]
    fn tell(&mut self) {
        while let Some(message) = self.device.next_message() {
            mail::post(message);
        }
    }

    /// Not inlined: it is asked once in 25 ticks, and all of them would carry it.
    #[inline(never)]
    fn save(&mut self) {
        self.device.slow_frame_passed();
        self.button.light(self.device.fingertip.light());
        self.device.fingertip.bridge(self.button.bridge_is_off());
        self.vibrator.drive(self.device.fingertip.feedback());
        self.slow_frames = self.slow_frames.saturating_add(1);
        if self.slow_frames == LIVED_WELL {
            last_words::lived_well();
        }
        if mail::store_is_free()
            && let Some(record) = self.device.next_record()
        {
            mail::save(record);
        }
    }

    fn take_command(&mut self) {
        // One in a tick: how long it takes is bounded, and its answer leaves the line to telemetry.
        if let Some(command) = mail::next_command() {
            self.take(&command);
        }
    }

    #[inline(never)]
    fn take(&mut self, command: &Received<Down>) {
        if let Some(message) = self.device.taken(command) {
            mail::post(message);
        }
        let done = tenax_control_command(&mut self.device, command);
        match command.message {
            Down::Last(_) => self.last(command, done),
            _ => mail::post(self.device.answer(command, done)),
        }
    }

    /// Apart, for the other answers need not lie anywhere before they are posted: that is another copy.
    #[inline(never)]
    fn last(&mut self, command: &Received<Down>, done: Result<(), Refusal>) {
        let mut answer = self.device.answer(command, done);
        black_box::read(&mut answer);
        mail::post(answer);
    }
}

/// A tick in which frames or readings may be sent, that ends a slow frame, or after which muscles and films are thought about (7000
/// instructions where a spectrum is due) or a record is made (every setting), has no room for a command and its answer as well, streamed
/// or not.
fn has_room_for_command(frame: &Frame) -> bool {
    let slot = frame.slot();
    !usize::from(slot).is_multiple_of(FRAMES_PER_RAW)
        && ![SENSES_SLOT, slot_of(Job::Think), slot_of(Job::Save)].contains(&slot)
        && !frame.ends_slow_frame()
}

/// One tick of the logic. Not inlined, so that the emulated board can count its instructions by this name.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_control_tick(fingertip: &mut Fingertip, frame: &Frame) -> MotorDrive {
    fingertip.tick(frame)
}

/// A command taken. Not inlined, so that the emulated board can tell by this name before which tick that was.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_control_command(device: &mut Device, command: &Received<Down>) -> Result<(), Refusal> {
    device.carry_out(command)
}

#[embassy_executor::task]
pub async fn control(scan: Scan, control: &'static mut Control) -> ! {
    scan.run(|frame| control.on_frame(frame)).await
}
