//! The boards that a plant can be connected to, and what a run on one leaves behind.

pub mod agreement;
#[cfg(feature = "emulator")]
pub mod emulated;
pub mod line_log;
pub mod simulated;

use tenax_hal_shim::frame::Scan;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Answer, Counters, Down, Event, NetworkState, Slow};
use tenax_hal_shim::words::{Fault, Kept};

/// What the core spent, in instructions of the emulated Cortex-M4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TickCost {
    /// Ticks counted.
    pub count: u64,
    /// Mean of one tick of the logic, what interrupted it included.
    pub instructions_mean: f64,
    /// Worst.
    pub instructions_max: u64,
    /// Everything that the core executed in a second: ticks, interrupts, telemetry. It sleeps for the rest.
    pub instructions_per_s: f64,
}

/// What a run leaves behind.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Virtual time run, s.
    pub virtual_s: f64,
    /// Time it took, s.
    pub wall_s: f64,
    /// The codes at the converter's inputs at every trigger of a scan, in order: four make a frame.
    pub scans: Vec<Scan>,
    /// How the motor was driven when each scan period ended, as the plant saw it.
    pub drives: Vec<MotorDrive>,
    /// Whether the object moved relative to the finger at each scan, for the oracle and the scores.
    pub slipping: Vec<bool>,
    /// Commands that the logic took, each with the sequence number of the frame before whose tick it took it. After a
    /// restart the emulated board's count goes on.
    pub taken: Vec<(u32, Down)>,
    /// Slow frames, as they came up the line.
    pub slows: Vec<Slow>,
    /// Events, as they came up the line.
    pub events: Vec<Event>,
    /// Commands that were answered: the sequence number of each, and its answer.
    pub answers: Vec<(u16, Answer)>,
    /// What was saved, with the sequence number of the last frame before.
    pub saved: Vec<(u32, Kept)>,
    /// Why the board started, each time it did.
    pub starts: Vec<Option<Fault>>,
    /// The last counters.
    pub counters: Counters,
    /// Messages missing from the line by their sequence numbers.
    pub messages_missed: u64,
    /// Frames that came up the line and were no message.
    pub bad_frames: u64,
    /// Every byte that came up the line: what `tenax monitor` would have read.
    pub line: Vec<u8>,
    /// None where instructions cannot be counted.
    pub tick_cost: Option<TickCost>,
    /// The deepest that the stack was, bytes. None where it cannot be measured.
    pub stack_bytes: Option<u64>,
    /// What was done to the flash.
    pub flash: FlashUse,
}

impl Run {
    /// The network, each time it was asked for.
    pub fn networks(&self) -> impl Iterator<Item = &NetworkState> {
        networks(self.answers.iter().map(|(_, answer)| answer))
    }
}

/// The networks among `answers`.
fn networks<'a>(answers: impl Iterator<Item = &'a Answer>) -> impl Iterator<Item = &'a NetworkState> {
    answers.filter_map(|answer| match answer {
        Answer::Network(network) => Some(network),
        _ => None,
    })
}

/// What was done to the flash.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlashUse {
    /// Words programmed.
    pub words: u64,
    /// Sectors erased.
    pub erases: u64,
}
