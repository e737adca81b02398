//! The task of the map and the failures: Tada's pick-up (figures 5 and 6) as statistics without physics, stated completely so that
//! its theory can be worked out.
//!
//! One trial: its phases in ms, the true codes v1 and v2, the grasping force P and the shear S relative to their maxima:
//!
//! | from | phase | v1 | v2 | P | S |
//! |---|---|---|---|---|---|
//! | 0 | the hand lifts, the fingers slip: they press too little to carry it | -1 | 1 | 0.4 | 0.35 |
//! | 1500 | the object is lifted | 1 | 1 | 0.8 | 0.6 |
//! | 3000 | it is held, nothing moves | 0 | 0 | 0.8 | 0.6 |
//! | 4000 | it is lowered | 1 | -1 | 0.8 | 0.6 |
//! | 5500 | it stands, the fingers slip down along it | -1 | -1 | 0.8 | -0.7 |
//! | 7000 | end | | | | |
//!
//! Each code is taught as long as its opposite: why that matters is in `docs/hebbian.md`.
//!
//! The camera sees each 66 ms late, at its next picture (33 ms). A vibration receptor gives `0.6 exp(0.5 g)`, at most 1, while it
//! slips, g a first-order Gauss process of 20 ms, half of it common to all, and noise `0.02 / depth` all the time. A
//! pressure receptor gives `a P + b S` with `|a| + |b| = 1` of its own, and noise of 0.02. The last receptor is an offset:
//! 0.8, whatever happens.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_host_tests::gauss;
use tenax_logic::hebbian::{Activation, Activations, Code, Codes, RECEPTORS};

pub const VIBRATION: usize = 12;
pub const OFFSET: usize = RECEPTORS - 1;
/// Trials in a lesson (Tada 2006, section III.C).
pub const TRIALS: u64 = 7;

const TRIAL_MS: usize = 7_000;
const SEEN_AFTER_MS: usize = 66;
const PICTURE_MS: usize = 33;

#[derive(Clone, Debug)]
pub struct Finger {
    noise: [f64; VIBRATION],
    mix: [(f64, f64); RECEPTORS - VIBRATION],
}

#[derive(Clone, Copy, Debug)]
pub struct Moment {
    pub felt: Activations<RECEPTORS>,
    pub truth: Codes,
    pub seen: Codes,
}

impl Moment {
    /// Codes to learn; none while nothing moves.
    pub fn lesson(&self) -> Option<Codes> {
        (self.seen != [Code::Zero; 2]).then_some(self.seen)
    }
}

fn phase(ms: usize) -> (Codes, f64, f64) {
    use Code::{Minus, Plus, Zero};
    match ms {
        0..1_500 => ([Minus, Plus], 0.4, 0.35),
        1_500..3_000 => ([Plus, Plus], 0.8, 0.6),
        3_000..4_000 => ([Zero, Zero], 0.8, 0.6),
        4_000..5_500 => ([Plus, Minus], 0.8, 0.6),
        _ => ([Minus, Minus], 0.8, -0.7),
    }
}

impl Finger {
    pub fn new(seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        Self {
            noise: std::array::from_fn(|_| 0.02 / rng.random_range(0.2..1.0)),
            mix: std::array::from_fn(|_| {
                let shear: f64 = rng.random_range(-1.0..1.0);
                (1.0 - shear.abs(), shear)
            }),
        }
    }

    pub fn trial(&self, seed: u64) -> Vec<Moment> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let keep = f64::exp(-1.0 / 20.0);
        let fresh = (1.0 - keep * keep).sqrt();
        let mut common = gauss(&mut rng);
        let mut own: [f64; VIBRATION] = std::array::from_fn(|_| gauss(&mut rng));
        (0..TRIAL_MS)
            .map(|ms| {
                let (truth, pressure, shear) = phase(ms);
                common = keep * common + fresh * gauss(&mut rng);
                let felt = std::array::from_fn(|j| match j {
                    OFFSET => 0.8,
                    VIBRATION.. => {
                        let (a, b) = self.mix[j - VIBRATION];
                        a * pressure + b * shear + 0.02 * gauss(&mut rng)
                    }
                    _ => {
                        own[j] = keep * own[j] + fresh * gauss(&mut rng);
                        let g = (common + own[j]) * 0.5f64.sqrt();
                        let slip = if truth[0] == Code::Minus { 0.6 * (0.5 * g).exp() } else { 0.0 };
                        slip + self.noise[j] * gauss(&mut rng).abs()
                    }
                });
                let picture = ms / PICTURE_MS * PICTURE_MS;
                Moment {
                    felt: Activations::new(felt.map(Activation::from_f64)),
                    truth,
                    seen: phase(picture.saturating_sub(SEEN_AFTER_MS)).0,
                }
            })
            .collect()
    }

    pub fn lesson(&self) -> Vec<Moment> {
        (0..TRIALS).flat_map(|trial| self.trial(trial)).collect()
    }
}
