//! What an object bears: a can that is crushed, a crane of paper that tears.

use crate::file::sections::Object;

/// Width and stiffness between the fingers, and the force at which they give way.
///
/// Crushing is ideally plastic: the wall yields at its limit and keeps the dent, so no finger ever presses harder than
/// the limit while there is something left to crush. Breaking is an instant after which the object is no more.
#[derive(Clone, Debug)]
pub struct Body {
    width_mm: f64,
    stiffness_n_per_mm: f64,
    crush_n: f64,
    break_n: f64,
    dent_mm: f64,
    broken: bool,
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

    pub const fn stiffness_n_per_mm(&self) -> f64 {
        self.stiffness_n_per_mm
    }

    pub const fn dent_mm(&self) -> f64 {
        self.dent_mm
    }

    pub const fn is_broken(&self) -> bool {
        self.broken
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SceneFile;

    fn can(limits: &str) -> Body {
        let (_, glass) = crate::builtin()[0];
        let text = glass.replace("mass_kg = 0.25", &format!("{limits}\nmass_kg = 0.25"));
        Body::new(SceneFile::parse(&text, "can").unwrap().object.as_ref().unwrap().get_ref())
    }

    #[test]
    fn it_yields_at_its_limit_and_keeps_the_dent() {
        let mut can = can("crush_n = 8");
        assert_eq!((can.bears(7.9), can.dent_mm()), (7.9, 0.0));
        // The fingers want 11 N at 3 N/mm: 3 N too much is 1 mm a finger.
        assert_eq!((can.bears(11.0), can.dent_mm()), (8.0, 2.0));
        assert_eq!(can.width_mm(), 68.0);
        assert_eq!((can.bears(5.0), can.dent_mm()), (5.0, 2.0));
    }

    #[test]
    fn it_breaks_once_and_for_good() {
        let mut egg = can("break_n = 20");
        egg.bears(19.9);
        assert!(!egg.is_broken());
        egg.bears(20.1);
        egg.bears(0.0);
        assert!(egg.is_broken() && egg.dent_mm() == 0.0);
    }
}
