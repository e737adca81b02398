//! What a board sees of a world: voltages on its pins, and a motor that moves something.

use tenax_hal_shim::channel::{CHANNELS, CODE_MAX, COUNT, REFERENCE_MV};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::Down;

/// Voltages at the pins, V, in the order of [`CHANNELS`].
#[derive(Clone, Debug, PartialEq)]
pub struct Pins(pub [f64; COUNT]);

impl Default for Pins {
    /// Every channel at rest.
    fn default() -> Self {
        Self(CHANNELS.map(|channel| f64::from(channel.rest_mv) / 1e3))
    }
}

impl Pins {
    /// The codes that the converter reads, 12 bits, rounded down as it does, clipped to its range. NaN reads as 0.
    #[must_use]
    pub fn codes(&self) -> [u16; COUNT] {
        self.0.map(|volts| {
            let code = volts * 1e3 / f64::from(REFERENCE_MV) * (f64::from(CODE_MAX) + 1.0);
            // A maximum with NaN is the other one.
            code.max(0.0).min(f64::from(CODE_MAX)) as i32 as u16
        })
    }
}

/// A world (a scene) or a recording, seen from the board, one scan at a time.
pub trait Plant: Send {
    /// Goes on by one scan period (125 us) under `drive` and gives the voltages at the pins at its end.
    fn scan(&mut self, drive: MotorDrive) -> &Pins;

    /// Commands that somebody sends over the serial line at this instant.
    fn commands(&mut self) -> Vec<Down> {
        Vec::new()
    }

    /// Whether the object moves relative to the finger at this instant: what the oracle is told.
    fn slipping(&self) -> bool {
        false
    }

    /// How long it lasts, s.
    fn duration_s(&self) -> f64;
}
