//! The words between the friction of a grasp and the pulses that answer it: the grip asks, friction tells.

/// What Ft/Fn tells of the friction of what slides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slides {
    /// Nothing yet: slip was not said, or not long enough ago.
    Unknown,
    /// It is that friction.
    Now,
    /// It was that friction within the last readings. What has come to rest meanwhile carries less.
    Again,
}

/// The force that a grip lacks, mN. None where that is not known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lacks {
    /// If the object slips now.
    pub slip_mn: Option<i32>,
    /// If it is about to.
    pub warning_mn: Option<i32>,
    /// Whether S2 warns of that.
    pub by_s2: bool,
}
