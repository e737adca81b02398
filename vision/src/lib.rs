//! A camera behind a clear skin (FingerVision 2017): force from markers on the skin; an object, its direction, and whether it slips.
//! Pictures are of 320 x 240 pixels. [`Camera`] takes a picture and gives a [`Summary`]; time is the caller's.
#![forbid(unsafe_code)]

pub mod camera;
pub mod force;
pub mod frame;
pub mod markers;
pub mod mask;
mod motion;
pub mod object;
pub mod quality;
pub mod rectify;
mod skin;

pub use camera::{Camera, Summary};
pub use frame::{Frame, Plane, Point};
