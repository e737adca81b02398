//! Figures as SVG: sheets of panels.

pub mod figure;
pub mod sheet;
pub mod thin;
