//! Normal and shear force from the four-quadrant force sensor, and S2, which judges their ratio.

mod detector;
pub mod friction;
pub mod fsr;
pub mod sensor;
pub mod settings;

pub use friction::FrictionDetector;
pub use sensor::ForceSensor;
