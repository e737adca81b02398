//! A finger of the hand: the host's own build of the logic, its line and its end of the bus, on a crystal of its own.

use tenax_hal_shim::channel::{COUNT, SCANS_PER_FRAME};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::frame::{Frame, Scan, scan_of_pins};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::schedule::{Job, slot_of};
use tenax_hal_shim::wire::{Event, EventKind, Identity, Up};
use tenax_logic::device::Device;
use tenax_palm::bus::{Chip, FRAME_MAX};
use tenax_palm::finger::{Answer, Finger};
use tenax_serial::link::Encoder;

use crate::board::simulated::downlink::Downlink;

/// A frame by the finger's own crystal, us.
const FRAME_US: f64 = 500.0;

#[derive(Debug)]
pub struct Board {
    pub device: Device,
    /// Its end of the bus.
    pub end: Finger,
    line: Encoder,
    down: Downlink,
    /// How fast its crystal runs, and what it shows at the beginning, us.
    rate: f64,
    begins_us: f64,
    next_us: f64,
    sequence: u32,
    codes: [[u16; COUNT]; SCANS_PER_FRAME],
    pub drive: MotorDrive,
    pub is_on: bool,
    /// Pulses that nobody but the palm wished for.
    pub wished: u32,
}

impl Board {
    /// Switched on, with a crystal that is off by so many ppm and shows this at the beginning, us.
    pub fn new(mut device: Device, chip: Chip, ppm: f64, begins_us: f64) -> Self {
        let about = device.start(Identity { chip, ..Identity::default() });
        let mut board = Self {
            device,
            end: Finger::new(chip),
            line: Encoder::default(),
            down: Downlink::default(),
            rate: 1.0 + ppm / 1e6,
            begins_us,
            next_us: begins_us + FRAME_US,
            sequence: 0,
            codes: [[0; COUNT]; SCANS_PER_FRAME],
            drive: MotorDrive::Coast,
            is_on: true,
            wished: 0,
        };
        board.post(&about);
        board
    }

    /// The time by its own crystal.
    pub fn own_us(&self, true_us: f64) -> f64 {
        true_us * self.rate + self.begins_us
    }

    /// Its converter has taken a scan of these codes.
    pub fn scan(&mut self, codes: [u16; COUNT]) {
        self.codes.rotate_left(1);
        self.codes[SCANS_PER_FRAME - 1] = codes;
    }

    /// Its power is gone: the bridge is off, and the gear holds.
    pub fn cut(&mut self) {
        (self.is_on, self.drive) = (false, MotorDrive::Coast);
    }

    /// Ticks if a frame has ended by its crystal.
    pub fn run(&mut self, true_us: f64) -> bool {
        let own_us = self.own_us(true_us);
        if !self.is_on || own_us < self.next_us {
            return false;
        }
        let ended_us = clock(self.next_us);
        self.next_us += FRAME_US;
        let sequence = self.sequence;
        self.sequence += 1;
        while let Some(byte) = self.end.line_byte() {
            self.down.take(&[byte]);
        }
        if let Some(command) = self.down.command(sequence) {
            let answer = self.device.command(&command);
            self.post(&answer);
        }
        let select = Frame::lost(sequence).select();
        let scans: [Scan; SCANS_PER_FRAME] = self.codes.map(|codes| scan_of_pins(&codes, select));
        let frame = Frame::from_scans(sequence, &scans);
        self.drive = self.device.tick(&frame);
        while let Some(message) = self.device.next_message() {
            self.end.note(&message);
            if let Up::Event(Event { kind: EventKind::Pulse { believed, .. }, .. }) = &message {
                self.wished += u32::from(*believed == DetectorSet::only(DetectorId::Injected));
            }
            self.post(&message);
        }
        if frame.slot() == slot_of(Job::Save) {
            self.device.slow_frame_passed();
        }
        self.end.ticked(self.device.fingertip_mut(), ended_us);
        true
    }

    fn post(&mut self, message: &Up) {
        self.end.post(self.line.frame(message).1);
    }

    /// A byte of the bus is over; its interrupt is so late.
    pub fn hear(
        &mut self,
        byte: u8,
        true_us: f64,
        late_us: f64,
        out: &mut [u8; FRAME_MAX],
    ) -> Option<Answer> {
        let own_us = clock(self.own_us(true_us + late_us));
        if self.is_on { self.end.hear(byte, own_us, out) } else { None }
    }

    /// What the palm is told that its clock showed when the last frame ended, less what it showed, us. None before the first poll.
    pub fn clock_error_us(&self) -> Option<f64> {
        let ended_us = self.next_us - FRAME_US;
        let told_us = self.end.palm_us(clock(ended_us))?;
        let true_us = (ended_us - self.begins_us) / self.rate;
        Some(f64::from(told_us.wrapping_sub(clock(true_us)).cast_signed()))
    }
}

/// A timer of 32 bits.
fn clock(us: f64) -> u32 {
    us as u64 as u32
}
