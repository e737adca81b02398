//! What really happened in a scene, as far as the scores need it.

use tenax_scene::Truth;

/// One slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipSpan {
    /// When some of the contact began to slide, s.
    pub micro_onset_s: f64,
    /// When all of it did, s. None if it never came to that.
    pub macro_onset_s: Option<f64>,
    /// When everything stuck again, s. Infinite if it never did.
    pub end_s: f64,
    /// How far the object slid, mm.
    pub distance_mm: f64,
    /// Whether the wearer was letting go, so that it was meant: nothing is to be caught.
    pub meant: bool,
}

/// What really happened.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fate {
    /// Every slip, in order.
    pub slips: Vec<SlipSpan>,
    /// How far the object slid altogether when it was not meant to, mm.
    pub distance_mm: f64,
    /// Whether it was dropped.
    pub dropped: bool,
    /// Whether the hand rose without it.
    pub left_behind: bool,
    /// Whether another hand has taken it.
    pub handed_over: bool,
    /// How far it had turned about the pads at the end, rad.
    pub turned_rad: f64,
    /// The greatest grip force, N. None where nothing was held.
    pub peak_grip_n: Option<f64>,
    /// When the fingers first crushed it, s.
    pub crushed_at_s: Option<f64>,
    /// How deep, for good, mm.
    pub dent_mm: f64,
    /// When it broke, s.
    pub broken_at_s: Option<f64>,
    /// The least force that would have held it at its heaviest, N.
    pub needed_force_n: Option<f64>,
}

impl Fate {
    /// A world's log, as far as it goes.
    #[must_use]
    pub fn of(truth: &Truth) -> Self {
        let slip = |slip: &tenax_scene::truth::Slip| SlipSpan {
            micro_onset_s: slip.micro_onset_s,
            macro_onset_s: Some(slip.macro_onset_s),
            end_s: slip.end_s.unwrap_or(f64::INFINITY),
            distance_mm: slip.distance_mm,
            meant: slip.meant,
        };
        let held = truth.needed_grip_n > 0.0;
        Self {
            slips: truth.slips.iter().map(slip).collect(),
            distance_mm: truth.slip_distance_mm,
            dropped: truth.dropped,
            left_behind: truth.left_behind,
            handed_over: truth.handed_over,
            turned_rad: truth.turned_rad,
            crushed_at_s: truth.crushed_at_s,
            dent_mm: truth.dent_mm,
            broken_at_s: truth.broken_at_s,
            peak_grip_n: (truth.peak_grip_n > 0.0).then_some(truth.peak_grip_n),
            needed_force_n: held.then_some(truth.needed_grip_n),
        }
    }
}
