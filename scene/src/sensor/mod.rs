//! Sensors: from the world to volts at the pins.

pub(crate) mod array;
pub mod camera;
pub(crate) mod converter;
pub(crate) mod fault;
pub(crate) mod fsr;
pub(crate) mod hand;
pub(crate) mod myo;
pub mod photoelastic;
mod place;
pub(crate) mod pvdf;
pub(crate) mod skin;
pub(crate) mod strain;

const CLIP_V: std::ops::RangeInclusive<f64> = 0.05..=3.2;

pub(crate) fn front_end_v(mv: f64) -> f64 {
    (mv / 1e3).clamp(*CLIP_V.start(), *CLIP_V.end())
}
