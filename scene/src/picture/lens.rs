//! A fisheye lens: equidistant, r = f theta.

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    pub focal_px: f64,
    pub middle: (f64, f64),
}

impl Lens {
    pub fn seen(&self, (x, y): (f64, f64)) -> (f64, f64) {
        self.scaled((x, y), |r| self.focal_px * libm::atan(r / self.focal_px))
    }

    pub fn flat(&self, (x, y): (f64, f64)) -> (f64, f64) {
        // Nothing is seen beyond 80 degrees.
        self.scaled((x, y), |r| self.focal_px * libm::tan((r / self.focal_px).min(1.4)))
    }

    fn scaled(&self, (x, y): (f64, f64), radius: impl Fn(f64) -> f64) -> (f64, f64) {
        let (dx, dy) = (x - self.middle.0, y - self.middle.1);
        let r = libm::hypot(dx, dy);
        if r < 1e-9 || !self.focal_px.is_finite() {
            return (x, y);
        }
        let scale = radius(r) / r;
        (self.middle.0 + dx * scale, self.middle.1 + dy * scale)
    }
}
