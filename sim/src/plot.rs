//! Figures as SVG: a run's stacked panels over one time axis, and the sheets of the studies' charts.

pub mod draw;
pub mod figure;
pub mod sheet;
pub mod thin;

pub use figure::Figure;
