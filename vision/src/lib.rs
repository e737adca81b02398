//! What a camera behind a clear skin tells (FingerVision 2017): where the markers on the skin are and so what force acts
//! on it, where an object is, how it lies, and whether it slips.
//!
//! Pictures are of 320 x 240 pixels. Enter by [`Camera`], which takes a picture and gives a [`Summary`]; time is the caller's.
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
