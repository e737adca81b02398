//! The boards that a plant can be connected to, and what a run on one leaves behind.

pub mod simulated;

use tenax_hal_shim::frame::Scan;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Counters, Event, Slow};
use tenax_hal_shim::words::Fault;

/// What the core spent on ticks, in instructions of the emulated Cortex-M4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TickCost {
    /// Ticks counted.
    pub count: u64,
    /// Mean.
    pub instructions_mean: f64,
    /// Worst.
    pub instructions_max: u64,
}

/// What a run leaves behind.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Virtual time run, s.
    pub virtual_s: f64,
    /// Time it took, s.
    pub wall_s: f64,
    /// The codes of every scan that the converter was triggered for, in order: four make a frame.
    pub scans: Vec<Scan>,
    /// How the motor was driven when each scan period ended, as the plant saw it.
    pub drives: Vec<MotorDrive>,
    /// Whether the object moved relative to the finger at each scan, for the oracle and the scores.
    pub slipping: Vec<bool>,
    /// Slow frames, as they came up the line.
    pub slows: Vec<Slow>,
    /// Events, as they came up the line.
    pub events: Vec<Event>,
    /// Why the board started, each time it did.
    pub starts: Vec<Option<Fault>>,
    /// The last counters.
    pub counters: Counters,
    /// Messages missing from the line by their sequence numbers.
    pub messages_missed: u64,
    /// Every byte that came up the line: what `tenax monitor` would have read.
    pub line: Vec<u8>,
    /// None where instructions cannot be counted.
    pub tick_cost: Option<TickCost>,
}
