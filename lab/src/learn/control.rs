//! Controls of learning: the same fingertip, with something of what it has learned changed.

use tenax_logic::hebbian::network::Weight;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// Each film's part of o1 is the mean of theirs: their sum is the same.
    EqualWeights,
    /// Each film has another's weight.
    ShuffledWeights,
    /// The films report nothing.
    ShearAlone,
    Untaught,
}

impl Control {
    pub const ALL: [Self; 4] = [Self::EqualWeights, Self::ShuffledWeights, Self::ShearAlone, Self::Untaught];

    pub const fn name(self) -> &'static str {
        match self {
            Self::EqualWeights => "equal weights",
            Self::ShuffledWeights => "shuffled weights",
            Self::ShearAlone => "shear alone",
            Self::Untaught => "untaught",
        }
    }

    /// Changes the films' weights of o1, and gives the ratio of slip, per mille with 8 fraction bits.
    pub fn change(self, films: &mut [Weight], slips_at: u32) -> u32 {
        match self {
            Self::EqualWeights => {
                let sum: i64 = films.iter().map(|weight| i64::from(weight.into_bits())).sum();
                films.fill(Weight::from_bits((sum / films.len().max(1) as i64) as i32));
            }
            // Where each film lies is chance already; half way round, none keeps its own weight.
            Self::ShuffledWeights => films.rotate_left(films.len() / 2),
            Self::ShearAlone | Self::Untaught => films.fill(Weight::default()),
        }
        if self == Self::Untaught { 0 } else { slips_at }
    }
}
