//! Normal and shear force from four quadrants, their drift, and warnings from the ratio (S2, look-ahead).

mod ahead;
mod asked;
mod contact;
pub mod drift;
pub mod friction;
pub mod fsr;
pub mod sensor;
pub mod settings;
mod shear;

pub use ahead::Ahead;
pub use asked::Asked;
pub use friction::FrictionDetector;
pub use sensor::ForceSensor;
pub use shear::shear_mrad;
