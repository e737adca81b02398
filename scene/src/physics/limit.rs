//! Limits of an object: a can that is crushed, an egg that breaks.

use crate::file::sections::Object;

/// Width and stiffness between the fingers, and the force at which they give way.
/// Crushing is ideally plastic: the wall yields at its limit and keeps the dent, so no finger ever presses harder than
/// the limit while there is something left to crush. Breaking is an instant after which the object is no more.
#[derive(Clone, Debug)]
pub struct Body {
    width_mm: f64,
    /// Pad and object together, N/mm a finger.
    pub(crate) stiffness_n_per_mm: f64,
    crush_n: f64,
    break_n: f64,
    pub(crate) dent_mm: f64,
    pub(crate) broken: bool,
}

impl Body {
    pub(crate) fn new(object: &Object) -> Self {
        let limit_n =
            |limit: Option<crate::file::quantity::Newtons>| limit.map_or(f64::INFINITY, |n| n.get());
        Self {
            width_mm: object.width_mm.get(),
            stiffness_n_per_mm: object.stiffness_n_per_mm.get(),
            crush_n: limit_n(object.crush_n),
            break_n: limit_n(object.break_n),
            dent_mm: 0.0,
            broken: false,
        }
    }

    pub fn bears(&mut self, grip_n: f64) -> f64 {
        self.broken |= grip_n > self.break_n;
        let over_n = grip_n - self.crush_n;
        if over_n <= 0.0 {
            return grip_n;
        }
        // The two fingers share the change of the width.
        self.dent_mm = (self.dent_mm + 2.0 * over_n / self.stiffness_n_per_mm).min(self.width_mm);
        self.crush_n
    }

    pub fn width_mm(&self) -> f64 {
        self.width_mm - self.dent_mm
    }
}
