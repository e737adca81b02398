//! A world as a board sees it: voltages at its pins, and a motor.

use tenax_hal_shim::channel::{CHANNELS, CODE_MAX, COUNT, REFERENCE_MV};
use tenax_hal_shim::frame::{Frame, scan_of_pins};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::Down;
use tenax_hal_shim::words::Kept;

use crate::act::Act;

/// Voltages at the pins, V, in the order of [`CHANNELS`].
#[derive(Clone, Debug, PartialEq)]
pub struct Pins(pub [f64; COUNT]);

impl Default for Pins {
    fn default() -> Self {
        Self(CHANNELS.map(|channel| f64::from(channel.rest_mv) / 1e3))
    }
}

impl Pins {
    /// The codes that the converter reads, 12 bits, rounded down as it does, clipped to its range. NaN reads as 0.
    pub fn codes(&self) -> [u16; COUNT] {
        let code = |volts: f64| volts * 1e3 / f64::from(REFERENCE_MV) * (f64::from(CODE_MAX) + 1.0);
        // A cast rounds towards 0 and clips.
        self.0.map(|volts| (code(volts) as u16).min(CODE_MAX))
    }
}

/// The wearer to whom the board was calibrated before the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Calibrated {
    Levels { rest_mv: [u16; 2], close_mv: [u16; 2], open_mv: [u16; 2] },
    Words([i32; 11]),
}

/// Names the field of a plant that is the one within it.
#[macro_export]
macro_rules! put_around {
    ($within:ident) => {
        fn within(&self) -> Option<&dyn $crate::plant::Plant> {
            Some(&self.$within)
        }

        fn within_mut(&mut self) -> Option<&mut dyn $crate::plant::Plant> {
            Some(&mut self.$within)
        }
    };
}

/// A world (a scene) or a recording, seen from the board, one scan at a time.
/// One that is put around another names it as `within`, and says itself only what is different.
pub trait Plant: Send {
    /// The plant that this one is put around; every method below that is not overridden asks it.
    fn within(&self) -> Option<&dyn Plant> {
        None
    }

    fn within_mut(&mut self) -> Option<&mut dyn Plant> {
        None
    }

    /// Goes on by one scan (125 us) under `drive`; voltages at the pins at its end.
    fn scan(&mut self, drive: MotorDrive) -> &Pins;

    /// Goes on by a frame: its samples, and the commands that came down the line meanwhile.
    fn frame(&mut self, sequence: u32, drive: MotorDrive) -> (Frame, Vec<Down>) {
        let select = Frame::lost(sequence).select();
        let mut commands = Vec::new();
        let scans = std::array::from_fn(|_| {
            let scan = scan_of_pins(&self.scan(drive).codes(), select);
            commands.extend(self.commands());
            scan
        });
        (Frame::from_scans(sequence, &scans), commands)
    }

    fn commands(&mut self) -> Vec<Down> {
        self.within_mut().map_or_else(Vec::new, Plant::commands)
    }

    fn line_bytes(&mut self) -> Vec<u8> {
        self.within_mut().map_or_else(Vec::new, Plant::line_bytes)
    }

    /// Drive of the vibration motor from now on. A recording ignores it.
    fn vibrate(&mut self, duty: Duty) {
        if let Some(within) = self.within_mut() {
            within.vibrate(duty);
        }
    }

    /// Act of a person at the bench, from now on. A recording ignores it.
    fn act(&mut self, act: Act) {
        if let Some(within) = self.within_mut() {
            within.act(act);
        }
    }

    /// Setting `line-trusted-flag`, kept in the flash from before.
    fn trusts_line(&self) -> bool {
        self.within().is_some_and(Plant::trusts_line)
    }

    /// Setting `stream-at-start-flag`, kept in the flash from before.
    fn streams_at_start(&self) -> bool {
        self.within().is_some_and(Plant::streams_at_start)
    }

    fn kept(&self) -> Vec<(Kept, Vec<u8>)> {
        self.within().map_or_else(Vec::new, Plant::kept)
    }

    fn keep(&mut self, kept: Kept, payload: &[u8]) {
        if let Some(within) = self.within_mut() {
            within.keep(kept, payload);
        }
    }

    /// True if the board is reset at this instant: its run is over.
    fn resets(&self) -> bool {
        self.within().is_some_and(Plant::resets)
    }

    fn button(&self) -> bool {
        self.within().is_some_and(Plant::button)
    }

    /// Drive of the bound for the next frame, by its plan of the whole scene. None where nothing has to be closed, or nothing is planned.
    fn planned(&self) -> Option<MotorDrive> {
        self.within()?.planned()
    }

    /// Drive for the next frame with which each finger comes to press with `target_n` and no more. None if it will anyway.
    fn closing_to(&self, target_n: f64) -> Option<MotorDrive> {
        self.within()?.closing_to(target_n)
    }

    fn calibrated(&self) -> Option<Calibrated> {
        self.within()?.calibrated()
    }

    fn duration_s(&self) -> f64 {
        self.within().map_or(0.0, Plant::duration_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_rounded_down_and_clipped() {
        let lsb_v = f64::from(REFERENCE_MV) / 1e3 / (f64::from(CODE_MAX) + 1.0);
        let parts = [(-1e-9, 6), (1e-9, 7), (0.5, 7), (1.0 - 1e-9, 7)];
        for (part, code) in parts {
            assert_eq!(Pins([(7.0 + part) * lsb_v; COUNT]).codes(), [code; COUNT], "{part}");
        }
        let odd =
            [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.0, -lsb_v, 1e300, -1e300, 5e-324];
        let codes = odd.map(|volts| Pins([volts; COUNT]).codes()[0]);
        assert_eq!(codes, [0, 0, CODE_MAX, 0, 0, 0, CODE_MAX, 0, 0]);
    }
}
