//! The problems that every method is given, and what is right.

mod brush;
mod hold;
mod impact;
mod incline;
mod pick_up;
mod self_excited;
mod stick_slip;
mod stroke;

pub use brush::BrushCubic;
pub use hold::ShakenHold;
pub use impact::Impact;
pub use incline::Incline;
pub use pick_up::PickUp;
pub use self_excited::SelfExcited;
pub use stick_slip::StickSlip;
pub use stroke::Stroke;

use super::Method;

/// Something to step, and the figures by which one tells how well it was stepped.
pub trait Problem: Send + Sync {
    /// What charts call it.
    fn name(&self) -> &'static str;
    /// How long it lasts, s.
    fn duration_s(&self) -> f64;
    /// What came of it: figures divided by their own natural size, so that a difference of 0.01 is 1 %.
    fn figures(&self, method: &dyn Method, dt_s: f64) -> Vec<f64>;
    /// The figures of Coulomb's friction, where they have a closed form.
    fn closed_form(&self) -> Option<Vec<f64>>;
    /// The steps of `dt_s` that it takes, at least one.
    fn steps(&self, dt_s: f64) -> u64 {
        (self.duration_s() / dt_s).round().max(1.0) as u64
    }
}

/// The problems, as they ship.
#[must_use]
pub fn problems() -> [Box<dyn Problem>; 5] {
    [
        Box::new(Incline::default()),
        Box::new(BrushCubic::default()),
        Box::new(StickSlip::default()),
        Box::new(Impact::default()),
        Box::new(PickUp),
    ]
}

/// The worst difference of two sets of figures; infinite where one is not a number, or is missing.
#[must_use]
pub fn error(figures: &[f64], reference: &[f64]) -> f64 {
    if figures.len() != reference.len() {
        return f64::INFINITY;
    }
    let differences = figures.iter().zip(reference).map(|(a, b)| (a - b).abs());
    differences.fold(
        0.0,
        |worst, difference| if difference.is_nan() { f64::INFINITY } else { worst.max(difference) },
    )
}
