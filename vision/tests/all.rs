//! The tests of markers, and of recordings of the real sensor; `lab` scores the whole on drawn sessions.

mod common;

mod markers;
mod real_markers;
mod real_object;
