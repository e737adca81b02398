//! The figure of a run: what is drawn of it while it goes, and its panels.

pub mod panels;
pub mod sketch;
