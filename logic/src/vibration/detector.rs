//! S1 as a detector: the conditioning has compared the envelope already.

use tenax_hal_shim::channel::SLOW_HZ;
use tenax_hal_shim::detector::{DetectorHealth, DetectorId, Direction};

use crate::detectors::{Description, Detector, Said, Sensed, confidence};
use crate::vibration::settings::VibrationConfig;

#[derive(Clone, Copy, Debug, Default)]
pub struct S1 {
    level: u16,
    health: DetectorHealth,
}

impl Detector for S1 {
    const ID: DetectorId = DetectorId::S1;
    // Impacts, strokes over a table and the motor vibrate an empty hand too, and are soon over.
    const IMPLAUSIBLE_AFTER: u16 = SLOW_HZ as u16 / 2;
    type Config = VibrationConfig;

    fn step(&mut self, _config: &VibrationConfig, sensed: &Sensed<'_>) -> Option<Said> {
        self.level = sensed.vibration.level;
        self.health = if sensed.vibration_known { DetectorHealth::Working } else { DetectorHealth::Blind };
        Some(Said { slip: sensed.vibration.s1, incipient: sensed.vibration.slides })
    }

    fn describe(&self, config: &VibrationConfig) -> Description {
        Description {
            confidence_permille: confidence(self.level.into(), config.s1.into()),
            direction: Direction::Unknown,
            health: self.health,
            raw: self.level.into(),
        }
    }
}
