//! The place of a film in the contact, and its part of a patch's micro slip.

use crate::random::Noise;

/// Half of what a film covers, in pressure over its peak (assumed: a film a third as wide as the contact).
const HALF_WIDTH: f64 = 0.15;

/// A place in the contact.
///
/// Places are told apart by the pressure there over its peak, w, as the brush's rings are: 0 at the edge of the contact, 1
/// in its middle; what lies outside w is the part `w^2` of the area and carries `w^3` of the load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    low: f64,
    high: f64,
    own: f64,
}

impl Place {
    pub(super) const EVERYWHERE: Self = Self { low: 0.0, high: 1.0, own: 0.0 };

    pub(super) fn random(making: &mut Noise) -> Self {
        let middle = making.between(0.0, 1.0).sqrt();
        let own = 1.0 - making.between(0.0, 1.0) / 2.0;
        Self { low: (middle - HALF_WIDTH).max(0.0), high: (middle + HALF_WIDTH).min(1.0), own }
    }

    pub(super) fn hears_release(self, from: f64, to: f64) -> f64 {
        let load = cube(to) - cube(from);
        if load <= 0.0 {
            return 1.0;
        }
        let here = cube(to.min(self.high)) - cube(from.max(self.low));
        (1.0 - self.own) + self.own * here.max(0.0) / load / self.area()
    }

    pub(super) fn slides(self, edge: f64) -> f64 {
        let here = (square(edge.min(self.high)) - square(self.low)).max(0.0) / self.area();
        (1.0 - self.own) * square(edge) + self.own * here
    }

    fn area(self) -> f64 {
        square(self.high) - square(self.low)
    }
}

fn square(x: f64) -> f64 {
    x * x
}

fn cube(x: f64) -> f64 {
    x * x * x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Source;

    fn places() -> impl Iterator<Item = Place> {
        let mut making = Noise::new(1, Source::FilmMaking);
        (0..1_000).map(move |_| Place::random(&mut making))
    }

    #[test]
    fn a_contact_that_lets_go_whole_is_heard_alike_on_average_and_slides_everywhere() {
        let mean = places().map(|place| place.hears_release(0.0, 1.0)).sum::<f64>() / 1e3;
        assert!((0.95..1.05).contains(&mean), "{mean}");
        assert!(places().all(|place| (place.slides(1.0) - 1.0).abs() < 1e-12 && place.slides(0.0) == 0.0));
    }
}
