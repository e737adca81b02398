//! Types that the friction of a grasp and the reflex's pulses share.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slides {
    Unknown,
    Now,
    /// Sliding friction of the last readings; an object that has stopped since shows less.
    Again,
}

/// Missing normal force, mN. None if unknown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lacks {
    pub slip_mn: Option<i32>,
    pub warning_mn: Option<i32>,
    pub by_s2: bool,
}
