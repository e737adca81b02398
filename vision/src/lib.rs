//! What a camera behind a clear skin tells (FingerVision 2017): where the markers on the skin are and so what force acts
//! on it, where an object is, how it lies, and whether it slips.
//!
//! Everything works on 320 x 240 pixels, in `quarter/` on 160 x 120. Nothing is allocated after construction, nothing reads a clock, and the crate
//! needs no `std`: where pictures come from is the caller's business.
#![no_std]
#![forbid(unsafe_code)]

extern crate alloc;

pub mod camera;
pub mod force;
pub mod frame;
pub mod loads;
pub mod markers;
pub mod mask;
pub mod motion;
pub mod object;
pub mod quality;
pub mod rectify;
pub mod skin;

pub use camera::{Camera, Summary};
pub use frame::{Frame, Plane, Point};
