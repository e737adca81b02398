//! Types that the friction of a grasp and the reflex's pulses share.

/// Whether the present Ft/Fn is the friction of the sliding object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slides {
    /// Not known: slip was not reported, or not long enough ago.
    Unknown,
    /// It is.
    Now,
    /// It was within the last readings; an object that has come to rest since shows less.
    Again,
}

/// The force that a grip lacks, mN. None where that is not known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lacks {
    /// To stop an object that slips, mN.
    pub slip_mn: Option<i32>,
    /// To answer a warning, mN.
    pub warning_mn: Option<i32>,
    /// Whether S2 warns.
    pub by_s2: bool,
}
