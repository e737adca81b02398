//! The oracle: the same controller, told the true onset without delay. What it cannot do, the gripper cannot.

use serde::Serialize;

use super::fate::Fate;

/// The oracle's run, and how the real one compares.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Oracle {
    /// How far the object slid, mm.
    pub distance_mm: Option<f64>,
    /// The greatest grip force, N.
    pub peak_force_n: Option<f64>,
    /// The run's slip distance over the oracle's. Null where the oracle's object did not slide.
    pub distance_ratio: Option<f64>,
    /// The run's peak force over the oracle's.
    pub peak_force_ratio: Option<f64>,
}

impl Oracle {
    /// Compares.
    #[must_use]
    pub fn of(run: Option<&Fate>, oracle: Option<&Fate>) -> Self {
        let (Some(run), Some(oracle)) = (run, oracle) else {
            return Self::default();
        };
        let ratio = |run: f64, oracle: f64| (oracle > 0.0).then(|| run / oracle);
        Self {
            distance_mm: Some(oracle.distance_mm),
            peak_force_n: oracle.peak_grip_n,
            distance_ratio: ratio(run.distance_mm, oracle.distance_mm),
            peak_force_ratio: run
                .peak_grip_n
                .zip(oracle.peak_grip_n)
                .and_then(|(run, oracle)| ratio(run, oracle)),
        }
    }
}
