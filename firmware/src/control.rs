//! The control task: a frame in, a motor drive out, every 0.5 ms. It waits for nothing but the next frame.

use embassy_stm32::peripherals::IWDG;
use embassy_stm32::wdg::IndependentWatchdog;
use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, select_of_place};
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::{MotorBridge, MotorDrive};
use tenax_hal_shim::wire::{Down, Up};
use tenax_logic::fingertip::Fingertip;

use crate::bridge::Bridge;
use crate::counts;
use crate::mail;
use crate::samples::LastSamples;
use crate::scan::Scan;
use crate::switches::Switches;

/// The watchdog's period, us. Control feeds it 200 times in one; nobody else does.
pub const WATCHDOG_US: u32 = 100_000;
/// Commands taken in one tick, so that a flood of them cannot make it late.
const COMMANDS_PER_TICK: usize = 2;

/// What a tick works with.
pub struct Control {
    fingertip: Fingertip,
    bridge: Bridge,
    switches: Switches,
    watchdog: IndependentWatchdog<'static, IWDG>,
    samples: LastSamples,
}

impl Control {
    /// A hand at rest.
    pub fn new(bridge: Bridge, switches: Switches, watchdog: IndependentWatchdog<'static, IWDG>) -> Self {
        Self { fingertip: Fingertip::default(), bridge, switches, watchdog, samples: LastSamples::default() }
    }

    /// Everything that a frame causes, the most urgent first.
    fn on_frame(&mut self, frame: &Frame) {
        let next = frame.sequence.wrapping_add(1);
        self.switches.show(select_of_place((next % u32::from(FRAMES_PER_SLOW_FRAME)) as u8));

        self.take_commands();
        let drive = tenax_control_tick(&mut self.fingertip, frame);
        self.bridge.drive(drive);
        self.watchdog.pet();
        counts::TICKS.add_one();

        self.samples.take(frame);
        if let Some(slow) = self.fingertip.take_slow() {
            mail::post(Up::Slow(slow));
        }
        while let Some(event) = self.fingertip.next_event() {
            mail::post(Up::Event(event));
        }
    }

    fn take_commands(&mut self) {
        for command in core::iter::from_fn(mail::next_command).take(COMMANDS_PER_TICK) {
            let refused = self.fingertip.command(&command.message).err();
            match command.message {
                Down::Samples => mail::post(self.samples.message()),
                Down::Network => mail::post(Up::Network(self.fingertip.network())),
                _ => {}
            }
            mail::post(Up::Ack { of: command.sequence, refused });
        }
    }
}

/// One tick of the logic. Not inlined, so that the emulated board can count its instructions by this name.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_control_tick(fingertip: &mut Fingertip, frame: &Frame) -> MotorDrive {
    fingertip.tick(frame)
}

/// Runs control from frame to frame, for ever.
#[embassy_executor::task]
pub async fn control(scan: Scan, mut control: Control) -> ! {
    control.watchdog.unleash();
    scan.run(|frame| control.on_frame(frame)).await
}
