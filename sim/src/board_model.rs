//! The NUCLEO-F411RE as `rigless` emulates it, with the models that stand in for some of `rigless`'s own.
//!
//! Here lives a model of the chip or its board, each with the reason why `rigless`'s own does not do; the chip's memories and
//! its flash array, which it leaves out; and the far end of the serial line. Every reason is one of two: `rigless` does not
//! draw it (words of the flash, a timer's trigger of the converter), or stops the core for what nobody sees (`docs/tools.md`).
//! No plant, no scene, no report, and nothing that knows the image's symbols: the bench drives the board and reads it.
//! Each stand-in has a test beside `rigless`'s own model, event for event; [`Models::Rigless`] runs without them.

mod bridge_timer;
pub mod flash;
pub mod line;
pub mod nucleo;
pub mod part;
mod scan_path;
mod serial_path;
mod unwatched;

/// Which models the chip is made of. The image cannot tell; one takes several times as long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Models {
    /// One event a frame for the converter, one a message for the serial line, none for the scan's timer and the bridge's
    /// edges; no MPU, whose guard no run of these tests touches.
    Quick,
    /// `rigless`'s own: an event for each conversion and each edge; the MPU with its eight regions.
    Rigless,
}
