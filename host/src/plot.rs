//! One figure a run: stacked panels over one time axis, as SVG and, drawn from that, as PNG.

pub mod draw;
pub mod figure;
mod lettering;
pub mod panels;
pub mod png;
mod shapes;
pub mod sketch;
pub mod thin;

pub use figure::Figure;
