//! One figure: stacked panels over one time axis, as SVG.
//!
//! Here lives how a figure is described, thinned and drawn: curves, levels and stretches with names, units and colours.
//! Nothing of a run: who draws one says what its curves are (the bench's `figure`).
//! No sample is read here and no file written; what comes in is numbers, what goes out is text or bytes.
//! It depends on no other crate of the workspace, so that it compiles beside them all.
//! The charts of the studies use its fonts and colours, and have their own sheets.

pub mod draw;
pub mod figure;
pub mod shapes;
pub mod sheet;
pub mod thin;

pub use figure::Figure;
