//! Reports from outside: of a scene that knows whether the object slips.

use tenax_hal_shim::detector::{DetectorHealth, DetectorId, Direction};

use super::{Description, Detector, Said, Sensed};

#[derive(Clone, Copy, Debug, Default)]
pub struct Injected(Option<Said>);

impl Injected {
    pub const fn inject(&mut self, said: Said) {
        self.0 = Some(said);
    }
}

impl Detector for Injected {
    const ID: DetectorId = DetectorId::Injected;
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
