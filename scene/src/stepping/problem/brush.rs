//! The brush patch, dragged from rest until all of it slides.

use super::Problem;
use crate::physics::brush::{BrushPatch, ELEMENTS, Pad, closed_form};
use crate::stepping::{Bristle, Method};

/// Each ring is one bristle, stepped by the method, at a constant speed. Right is `Q / (mu P) = (3 s - s^3) / 2`.
#[derive(Clone, Debug, PartialEq)]
pub struct BrushCubic {
    patch: BrushPatch,
    macro_slip_m: f64,
}

/// Of the drag, m/s.
const SPEED_M_S: f64 = 0.01;
const NORMAL_N: f64 = 2.0;
const MU: f64 = 0.5;
/// A fingertip: 5 mm of radius, 2 N/mm. Assumed.
const PAD: Pad = Pad { radius_m: 0.005, stiffness_n_per_m3: 2.55e7 };
/// The shear is compared at so many evenly spaced displacements.
const LOOKS: u64 = 25;

impl Default for BrushCubic {
    fn default() -> Self {
        Self { patch: BrushPatch::new(PAD, ELEMENTS), macro_slip_m: PAD.macro_slip_m(NORMAL_N, MU) }
    }
}

impl BrushCubic {
    /// The deflection at which each ring slides, m.
    fn sliding_m(&self) -> impl Iterator<Item = f64> {
        // w = p / p0, and 1.5 P over the area is p0.
        self.patch.elements().iter().map(|ring| ring.load_part() / ring.area_part() / 1.5 * self.macro_slip_m)
    }
}

impl Problem for BrushCubic {
    fn name(&self) -> &'static str {
        "brush cubic"
    }

    fn duration_s(&self) -> f64 {
        self.macro_slip_m / SPEED_M_S
    }

    /// The shear over `mu P` at evenly spaced displacements.
    fn figures(&self, method: &dyn Method, dt_s: f64) -> Vec<f64> {
        let steps = self.steps(dt_s).next_multiple_of(LOOKS);
        // A whole number of steps to each look.
        let dt_s = self.duration_s() / steps as f64;
        let mut rings: Vec<(Bristle, f64, f64)> = self
            .patch
            .elements()
            .iter()
            .zip(self.sliding_m())
            .map(|(ring, sliding_m)| (Bristle { sliding_m }, ring.area_part(), 0.0))
            .collect();
        let mut figures = Vec::new();
        for n in 1..=steps {
            for (bristle, _, bristle_m) in &mut rings {
                *bristle_m = method.drag(*bristle, *bristle_m, SPEED_M_S, dt_s);
            }
            if n % (steps / LOOKS) == 0 {
                let shear: f64 = rings.iter().map(|(_, area_part, bristle_m)| area_part * bristle_m).sum();
                figures.push(1.5 * shear / self.macro_slip_m);
            }
        }
        figures
    }

    fn closed_form(&self) -> Option<Vec<f64>> {
        Some((1..=LOOKS).map(|n| closed_form::shear(n as f64 / LOOKS as f64)).collect())
    }
}
