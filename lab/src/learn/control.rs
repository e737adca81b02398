//! Controls of what learning is worth: the same fingertip, with something of what it has learned changed.

use tenax_logic::hebbian::network::Weight;
use tenax_logic::setting::SettingId;

/// What is changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// Each film's part of o1 is the mean of theirs: their sum is the same and only which film to believe is gone.
    EqualWeights,
    /// A volt of each film counts alike: the weights undo what the normaliser has learned of each film, its maximum.
    EqualVolts,
    /// Each film has another's weight.
    ShuffledWeights,
    /// Slip is expected at the ratio at which S2 is set before any stroke, whatever the finger holds.
    UnlearnedFriction,
    /// Shear says nothing.
    FilmsAlone,
    /// The films say nothing.
    ShearAlone,
    /// Nothing was learned.
    Untaught,
}

impl Control {
    pub const ALL: [Self; 7] = [
        Self::EqualWeights,
        Self::EqualVolts,
        Self::ShuffledWeights,
        Self::UnlearnedFriction,
        Self::FilmsAlone,
        Self::ShearAlone,
        Self::Untaught,
    ];

    /// Its key in a report.
    pub const fn key(self) -> &'static str {
        match self {
            Self::EqualWeights => "equal_weights",
            Self::EqualVolts => "equal_volts",
            Self::ShuffledWeights => "shuffled_weights",
            Self::UnlearnedFriction => "unlearned_friction",
            Self::FilmsAlone => "films_alone",
            Self::ShearAlone => "shear_alone",
            Self::Untaught => "untaught",
        }
    }

    /// Changes the films' weights of o1, and gives the ratio of slip, per mille with 8 fraction bits. `maxima` are the films'.
    pub fn change(self, films: &mut [Weight], maxima: &[u32], slips_at: u32) -> u32 {
        let sum: i64 = films.iter().map(|weight| i64::from(weight.into_bits())).sum();
        match self {
            Self::EqualWeights => {
                films.fill(Weight::from_bits((sum / films.len().max(1) as i64) as i32));
                slips_at
            }
            Self::EqualVolts => {
                let all: i64 = maxima.iter().copied().map(i64::from).sum();
                for (weight, &largest) in films.iter_mut().zip(maxima) {
                    *weight = Weight::from_bits((sum * i64::from(largest) / all.max(1)) as i32);
                }
                slips_at
            }
            Self::ShuffledWeights => {
                // Where each film lies is chance already; half way round, none keeps its own weight.
                films.rotate_left(films.len() / 2);
                slips_at
            }
            Self::UnlearnedFriction => SettingId::S2.row().default.unsigned_abs() << 8,
            Self::FilmsAlone => 0,
            Self::ShearAlone => {
                films.fill(Weight::default());
                slips_at
            }
            Self::Untaught => {
                films.fill(Weight::default());
                0
            }
        }
    }
}

/// Each has its own place.
const _: () = {
    let mut n = 0;
    while n < Control::ALL.len() {
        assert!(Control::ALL[n] as usize == n);
        n += 1;
    }
};
