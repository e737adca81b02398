//! The photoelastic head as a detector: its flicker, while something is held and nothing else shakes it.

use tenax_hal_shim::detector::{DetectorHealth, DetectorId, Direction};

use super::{ALUMINIUM, HeadConfig};
use crate::detectors::{Description, Detector, Said, Sensed, confidence};
use tenax_hal_shim::channel::frames;

/// Time after an impact or a fast run of the motor: the load still changes, and the filters ring.
const AFTER_NOISE: u32 = frames(160);
const ANSWERED: u32 = frames(50);

#[derive(Clone, Copy, Debug, Default)]
pub struct PhotoelasticDetector {
    quiet: u32,
    loud: u32,
    slips: bool,
    level: i32,
    rate_um_s: i32,
    health: DetectorHealth,
}

impl Detector for PhotoelasticDetector {
    const ID: DetectorId = DetectorId::Photoelastic;
    type Config = HeadConfig;

    #[inline]
    fn step(&mut self, config: &HeadConfig, sensed: &Sensed<'_>) -> Option<Said> {
        config.fitted.then(|| self.judge(config, sensed))
    }

    fn describe(&self, config: &HeadConfig) -> Description {
        Description {
            confidence_permille: confidence(self.level, config.slip.into()),
            direction: Direction::Unknown,
            health: self.health,
            raw: self.rate_um_s,
        }
    }
}

impl PhotoelasticDetector {
    #[cold]
    #[inline(never)]
    fn judge(&mut self, config: &HeadConfig, sensed: &Sensed<'_>) -> Said {
        let head = sensed.head;
        (self.quiet, self.loud) =
            if sensed.noisy { (0, self.loud.saturating_add(1)) } else { (self.quiet.saturating_add(1), 0) };
        let goes_on = self.slips && self.loud < ANSWERED;
        let slips =
            sensed.valid && head.vibrates() && !sensed.unloaded && (self.quiet >= AFTER_NOISE || goes_on);
        self.slips = slips;
        if sensed.forces_are_new {
            self.level = head.level();
            self.rate_um_s = if slips { head.rate_um_s(config, &ALUMINIUM) } else { 0 };
            self.health = if head.is_usable { DetectorHealth::Working } else { DetectorHealth::Blind };
        }
        Said::slip(slips)
    }
}
