//! Evidence from outside: somebody who knows whether the object slips.

use tenax_hal_shim::detector::{DetectorHealth, DetectorId, Direction};

use super::{Description, Detector, Said, Sensed};

/// What was injected for the frame to come.
#[derive(Clone, Copy, Debug, Default)]
pub struct Injected(Option<Said>);

impl Injected {
    /// Says this from the next frame on.
    pub const fn inject(&mut self, said: Said) {
        self.0 = Some(said);
    }
}

impl Detector for Injected {
    const ID: DetectorId = DetectorId::Injected;
    // Whoever injects knows.
    const IMPLAUSIBLE_AFTER: u16 = u16::MAX;
    type Config = ();

    fn step(&mut self, _config: &(), _sensed: &Sensed<'_>) -> Option<Said> {
        self.0
    }

    fn describe(&self, _config: &()) -> Description {
        let said = self.0.is_some();
        Description {
            confidence_permille: if said { 1_000 } else { 0 },
            direction: Direction::Unknown,
            health: if said { DetectorHealth::Working } else { DetectorHealth::Starting },
            raw: 0,
        }
    }
}
