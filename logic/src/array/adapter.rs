//! The multilayer perceptron as a detector: its work is split over several ticks of a slow frame.

use tenax_hal_shim::detector::{DetectorHealth, DetectorId, Direction};

use super::{ARRAY_READ, ShippedDetector};
use crate::detectors::{Description, Detector, Said, Sensed};

#[derive(Clone, Debug, Default)]
pub struct MlpDetector(ShippedDetector);

impl Detector for MlpDetector {
    const ID: DetectorId = DetectorId::Mlp;
    type Config = ();

    /// Lost frames do their share too: it needs no sample of theirs, and an old verdict would stand
    /// meanwhile.
    fn step(&mut self, _config: &(), sensed: &Sensed<'_>) -> Option<Said> {
        let share = sensed.slot.checked_sub(ARRAY_READ)?;
        self.0.work(share.into(), sensed.taxels).map(|verdict| Said::slip(verdict.slip))
    }

    fn describe(&self, _config: &()) -> Description {
        let verdict = self.0.verdict();
        Description {
            confidence_permille: verdict.confidence_permille,
            direction: Direction::Unknown,
            health: match verdict.age_ms {
                0 => DetectorHealth::Working,
                u16::MAX => DetectorHealth::Starting,
                _ => DetectorHealth::Blind,
            },
            raw: self.0.logit().unwrap_or(0),
        }
    }
}
