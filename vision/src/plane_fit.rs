//! A plane through weighted values at places, by least squares.

/// Sums of the normal equations.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PlaneFit {
    n: f32,
    x: f32,
    y: f32,
    xx: f32,
    xy: f32,
    yy: f32,
    v: f32,
    xv: f32,
    yv: f32,
}

impl PlaneFit {
    pub(crate) fn add(&mut self, weight: f32, (x, y): (f32, f32), value: f32) {
        self.n += weight;
        (self.x, self.y) = (self.x + weight * x, self.y + weight * y);
        self.xx += weight * x * x;
        self.xy += weight * x * y;
        self.yy += weight * y * y;
        self.v += weight * value;
        (self.xv, self.yv) = (self.xv + weight * value * x, self.yv + weight * value * y);
    }

    /// Sum of the weights.
    pub(crate) fn weight(&self) -> f32 {
        self.n
    }

    /// Value at (0, 0), slope along x and slope along y. `stiffness` draws the value towards 0. None where the determinant is below
    /// `det_min`.
    pub(crate) fn solve(&self, stiffness: f32, det_min: f32) -> Option<[f32; 3]> {
        let Self { x, y, xx, xy, yy, v, xv, yv, .. } = *self;
        let n = self.n + stiffness;
        let det = n * (xx * yy - xy * xy) - x * (x * yy - xy * y) + y * (x * xy - xx * y);
        if det < det_min {
            return None;
        }
        let value = v * (xx * yy - xy * xy) - x * (xv * yy - xy * yv) + y * (xv * xy - xx * yv);
        let along_x = n * (xv * yy - xy * yv) - v * (x * yy - xy * y) + y * (x * yv - xv * y);
        let along_y = n * (xx * yv - xv * xy) - x * (x * yv - xv * y) + v * (x * xy - xx * y);
        Some([value / det, along_x / det, along_y / det])
    }
}
