//! The Hebbian network as a detector: its films' part reports slip, the look-ahead of shear warns.

use tenax_hal_shim::detector::{DetectorHealth, DetectorId, Direction};

use super::Situation;
use super::detector::{Felt, HebbianDetector, SHEAR_IS_JUDGED};
use crate::detectors::{Description, Detector, Said, Sensed, confidence};
use crate::hebbian::settings::HebbianConfig;

/// Least value of the second output that tells a direction; 128 is 1.
const DIRECTION_FROM: i8 = 16;

impl Detector for HebbianDetector {
    const ID: DetectorId = DetectorId::Hebbian;
    type Config = HebbianConfig;

    fn step(&mut self, config: &HebbianConfig, sensed: &Sensed<'_>) -> Option<Said> {
        if !sensed.valid {
            self.lose();
            return Some(Said::NOTHING);
        }
        if sensed.slot == SHEAR_IS_JUDGED {
            self.foretell(config, sensed.forces, sensed.grasp, sensed.unloaded || sensed.wearer);
        }
        let impact = sensed.vibration.impact;
        self.tick(
            config,
            &Felt {
                envelopes: sensed.envelopes,
                gauges: sensed.strain,
                gauge: usize::from(sensed.slot),
                loud: sensed.noisy,
                unloaded: sensed.unloaded,
                situation: Situation {
                    grasp: sensed.grasp,
                    disturbed: impact || sensed.moves || !sensed.vibration_known,
                },
            },
        );
        Some(Said { slip: self.slips(), incipient: self.warns() })
    }

    fn describe(&self, config: &HebbianConfig) -> Description {
        let raw = self.by_films_permille();
        let [_, o2] = self.outputs();
        let direction = match (self.slips() | self.warns(), o2) {
            (true, o2) if o2 <= -DIRECTION_FROM => Direction::Down,
            (true, o2) if o2 >= DIRECTION_FROM => Direction::Up,
            _ => Direction::Unknown,
        };
        let health = if self.is_quiet_known() { DetectorHealth::Working } else { DetectorHealth::Starting };
        Description {
            confidence_permille: confidence(-raw, config.slip_permille.into()),
            direction,
            health,
            raw,
        }
    }
}
