//! What a board sees of a world: voltages on its pins, and a motor that moves something.

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
        const MAX: f64 = CODE_MAX as f64;
        // Above this there is no room for a fraction: the sum's lowest bits are the nearest whole number.
        const WHOLE: f64 = 4_503_599_627_370_496.0;
        // Comparisons and sums only, so that the compiler takes several channels in one instruction.
        self.0.map(|volts| {
            let code = volts * 1e3 / f64::from(REFERENCE_MV) * (MAX + 1.0);
            // No number is greater than NaN, and so NaN is 0.
            let code = if code > 0.0 { code } else { 0.0 };
            let code = if code < MAX { code } else { MAX };
            let nearest = code + WHOLE;
            let down = if nearest - WHOLE > code { 1.0 } else { 0.0 };
            (nearest - down).to_bits() as u16
        })
    }
}

/// The wearer to whom the board was calibrated before the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Calibrated {
    Levels { rest_mv: [u16; 2], close_mv: [u16; 2], open_mv: [u16; 2] },
    Words([i32; 10]),
}

/// A world (a scene) or a recording, seen from the board, one scan at a time.
///
/// One that is put around another names it as `within`, and says itself only what is different.
pub trait Plant: Send {
    fn within(&self) -> Option<&dyn Plant> {
        None
    }

    fn within_mut(&mut self) -> Option<&mut dyn Plant> {
        None
    }

    fn scan(&mut self, drive: MotorDrive) -> &Pins;

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

    fn vibrate(&mut self, duty: Duty) {
        if let Some(within) = self.within_mut() {
            within.vibrate(duty);
        }
    }

    fn act(&mut self, act: Act) {
        if let Some(within) = self.within_mut() {
            within.act(act);
        }
    }

    fn trusts_line(&self) -> bool {
        self.within().is_some_and(Plant::trusts_line)
    }

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

    fn resets(&self) -> bool {
        self.within().is_some_and(Plant::resets)
    }

    fn button(&self) -> bool {
        self.within().is_some_and(Plant::button)
    }

    /// How the bound drives the motor for the next frame: it closes as its plan of the whole scene says, and stops what slides. None
    /// where nothing has to be closed, or nothing is planned.
    fn planned(&self) -> Option<MotorDrive> {
        self.within()?.planned()
    }

    /// How the motor has to be driven for the next frame so that each finger comes to press what it touches with `target_n`, and
    /// no more. None if it will anyway.
    fn closing_to(&self, target_n: f64) -> Option<MotorDrive> {
        self.within()?.closing_to(target_n)
    }

    fn slipping(&self) -> bool {
        self.within().is_some_and(Plant::slipping)
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

    struct Outspoken(Pins);

    impl Plant for Outspoken {
        fn scan(&mut self, _drive: MotorDrive) -> &Pins {
            &self.0
        }

        fn commands(&mut self) -> Vec<Down> {
            vec![Down::Ping]
        }

        fn line_bytes(&mut self) -> Vec<u8> {
            vec![7]
        }

        fn trusts_line(&self) -> bool {
            true
        }

        fn streams_at_start(&self) -> bool {
            true
        }

        fn button(&self) -> bool {
            true
        }

        fn planned(&self) -> Option<MotorDrive> {
            Some(MotorDrive::Coast)
        }

        fn closing_to(&self, _target_n: f64) -> Option<MotorDrive> {
            Some(MotorDrive::Coast)
        }

        fn slipping(&self) -> bool {
            true
        }

        fn calibrated(&self) -> Option<Calibrated> {
            Some(Calibrated::Words([3; 10]))
        }

        fn duration_s(&self) -> f64 {
            1.0
        }
    }

    struct Around<P>(P);

    impl<P: Plant> Plant for Around<P> {
        fn within(&self) -> Option<&dyn Plant> {
            Some(&self.0)
        }

        fn within_mut(&mut self) -> Option<&mut dyn Plant> {
            Some(&mut self.0)
        }

        fn scan(&mut self, drive: MotorDrive) -> &Pins {
            self.0.scan(drive)
        }
    }

    #[test]
    fn what_a_plant_around_another_does_not_say_the_other_says() {
        let said = |plant: &mut dyn Plant| {
            let flags = [plant.trusts_line(), plant.streams_at_start(), plant.button(), plant.slipping()];
            let down = (plant.commands(), plant.line_bytes());
            (flags, down, plant.planned(), plant.closing_to(1.0), plant.calibrated())
        };
        let mut around = Around(Around(Outspoken(Pins::default())));
        assert_eq!(said(&mut around), said(&mut Outspoken(Pins::default())));
        assert!(around.button() && around.calibrated().is_some(), "what it says is not what nobody says");
    }

    #[test]
    fn codes_are_rounded_down_and_clipped() {
        let lsb_v = f64::from(REFERENCE_MV) / 1e3 / (f64::from(CODE_MAX) + 1.0);
        let slowly = |volts: f64| {
            let code = volts * 1e3 / f64::from(REFERENCE_MV) * (f64::from(CODE_MAX) + 1.0);
            if code.is_nan() { 0 } else { code.floor().clamp(0.0, f64::from(CODE_MAX)) as u16 }
        };
        let parts = [-0.5, -1e-9, 0.0, 1e-9, 0.25, 0.5, 0.5 + 1e-9, 0.75, 1.0 - 1e-9];
        let near = (0..=4_096).flat_map(|code| parts.map(|part| (f64::from(code) + part) * lsb_v));
        let odd = [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.0, 1e300, -1e300, 5e-324];
        for volts in near.chain(odd) {
            let codes = Pins([volts; COUNT]).codes();
            assert_eq!(codes, [slowly(volts); COUNT], "{volts} V");
        }
    }
}
