//! Missing force of a warning.

/// Missing normal force, mN. None if unknown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lacks {
    pub warning_mn: Option<i32>,
    pub by_s2: bool,
}
