//! What really happened in a scene, as far as the scores need it.

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
}

/// What really happened.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fate {
    /// Every slip, in order.
    pub slips: Vec<SlipSpan>,
    /// How far the object slid altogether, mm.
    pub distance_mm: f64,
    /// Whether it was dropped.
    pub dropped: bool,
    /// The greatest grip force, N. None where nothing was held.
    pub peak_grip_n: Option<f64>,
    /// The least force that would have held it at its heaviest, N.
    pub needed_force_n: Option<f64>,
    /// Grip force over time, s and N.
    pub grip_n: Vec<(f64, f64)>,
    /// The least force that holds the object, over time, s and N.
    pub needed_n: Vec<(f64, f64)>,
}
