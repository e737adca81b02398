//! S1 as a detector: the conditioning has compared the envelope already.

use tenax_hal_shim::detector::{DetectorHealth, DetectorId, Direction};

use crate::detectors::{Description, Detector, Said, Sensed, confidence};
use crate::vibration::Vibration;
use crate::vibration::settings::VibrationConfig;

#[derive(Clone, Copy, Debug, Default)]
pub struct S1 {
    level: u16,
    health: DetectorHealth,
}

impl Detector for S1 {
    const ID: DetectorId = DetectorId::S1;
    type Config = VibrationConfig;

    fn step(&mut self, _config: &VibrationConfig, sensed: &Sensed<'_>) -> Option<Said> {
        self.level = sensed.vibration.level;
        self.health = if sensed.vibration_known { DetectorHealth::Working } else { DetectorHealth::Blind };
        let Vibration { s1, slides, .. } = sensed.vibration;
        Some(Said { slip: s1, incipient: slides })
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
