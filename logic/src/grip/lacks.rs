//! Types that the friction of a grasp and the reflex's pulses share.

/// Whether the present Ft/Fn is the friction of the sliding object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slides {
    /// Not known: slip was not reported, or not long enough ago.
    Unknown,
    /// Ft/Fn is the sliding friction.
    Now,
    /// Ft/Fn was the sliding friction within the last readings; an object that has stopped since shows less.
    Again,
}

/// The missing normal force, mN. None if not known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lacks {
    /// To stop an object that slips, mN.
    pub slip_mn: Option<i32>,
    /// To answer a warning, mN.
    pub warning_mn: Option<i32>,
    /// Whether S2 gives the warning.
    pub by_s2: bool,
}
