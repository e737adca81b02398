//! S2 as a detector.

use tenax_hal_shim::detector::{DetectorHealth, DetectorId, Direction};

use super::FrictionDetector;
use crate::detectors::{Description, Detector, Said, Sensed, confidence};
use crate::force::settings::FrictionConfig;

impl Detector for FrictionDetector {
    const ID: DetectorId = DetectorId::S2;
    type Config = FrictionConfig;

    fn step(&mut self, config: &FrictionConfig, sensed: &Sensed<'_>) -> Option<Said> {
        if sensed.wearer {
            self.renew();
        }
        let ratio = match sensed.forces {
            Some(_) if !sensed.forces_are_new => return None,
            Some(forces) => forces.ratio_permille,
            None => None,
        };
        self.carry(ratio.and(sensed.forces).map(|forces| forces.ft_mn), sensed.moves);
        Some(Said { slip: false, incipient: self.process(config, ratio) })
    }

    fn describe(&self, config: &FrictionConfig) -> Description {
        let ratio = self.ratio_permille().map_or(0, i32::from);
        Description {
            confidence_permille: confidence(ratio, config.s2_permille.into()),
            direction: Direction::Unknown,
            health: match self.ratio_permille() {
                Some(_) => DetectorHealth::Working,
                None => DetectorHealth::Blind,
            },
            raw: ratio,
        }
    }
}
