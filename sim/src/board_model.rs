//! The NUCLEO-F411RE as `rigless` emulates it, with the models that stand in for some of `rigless`'s own: the converter with
//! its DMA, the bridge's timer, the flash array and the chip's memories.
//!
//! `rigless` does not draw it (words of the flash, a timer's trigger of the converter), or stops the core for what nobody sees
//! (`docs/bring-up.md`). [`Models::Rigless`] runs without the stand-ins.

mod bridge_timer;
pub mod flash;
pub mod line;
pub mod nucleo;
pub mod part;
mod scan_path;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Models {
    /// One event a frame for the converter, none for the bridge's edges; no MPU, whose guard no run of these tests touches.
    Quick,
    /// `rigless`'s own: an event for each conversion and each edge; the MPU with its eight regions.
    Rigless,
}
