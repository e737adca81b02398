//! The boards that a plant can be connected to, and what a run on one leaves behind.
//!
//! What comes 80 times a second or more is handed to a [`Recorder`] while the run goes, so that a long run takes no more
//! memory than a short one. What is rare is in the [`Summary`]. A [`Run`] is the recorder that keeps everything.

pub mod agreement;
#[cfg(feature = "emulator")]
pub mod emulated;
pub mod kept;
pub mod line_log;
pub mod recorder;
pub mod simulated;

use std::ops::{Deref, DerefMut};

use tenax_hal_shim::frame::Scan;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{Answer, Counters, Down, Event, NetworkState, Received, Slow, Up};
use tenax_hal_shim::words::{Fault, Kept};
use tenax_logic::emg::model::EmgModel;

pub use recorder::Recorder;

/// What the core spent, in instructions of the emulated Cortex-M4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TickCost {
    pub count: u64,
    /// Mean of one tick of the logic, what interrupted it included.
    pub instructions_mean: f64,
    pub instructions_max: u64,
    /// Everything that the core executed in a second: ticks, interrupts, telemetry. It sleeps for the rest.
    pub instructions_per_s: f64,
}

/// What a run leaves behind in any case.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    pub virtual_s: f64,
    pub wall_s: f64,
    /// Whether the board trusted its line from the start.
    pub trusts_line: bool,
    /// Commands that the logic took, each with the sequence number of the frame before whose tick it took it. After a
    /// restart the emulated board's count goes on.
    pub taken: Vec<(u32, Received<Down>)>,
    /// Events, as they came up the line.
    pub events: Vec<Event>,
    /// Commands that were answered: the sequence number of each, and its answer.
    pub answers: Vec<(u16, Answer)>,
    /// What was saved, with the sequence number of the last frame before.
    pub saved: Vec<(u32, Kept)>,
    /// How the vibration motor was driven from which frame on, whenever that changed.
    pub feedback: Vec<(u32, Duty)>,
    /// Why the board started, each time it did.
    pub starts: Vec<Option<Fault>>,
    pub counters: Counters,
    /// Messages missing from the line by their sequence numbers.
    pub messages_missed: u64,
    /// Frames that came up the line and were no message.
    pub bad_frames: u64,
    /// Bytes that came up the line.
    pub line_bytes: usize,
    /// None where instructions cannot be counted.
    pub tick_cost: Option<TickCost>,
    /// The deepest that the stack was, bytes. None where it cannot be measured.
    pub stack_bytes: Option<u64>,
    /// What was done to the flash.
    pub flash: FlashUse,
    /// The wearer to whom the board was calibrated before the start.
    pub calibrated: Option<EmgModel>,
}

/// Everything of a run: its summary, and what a [`Recorder`] hears, kept. An hour takes a gigabyte, so this is for short
/// runs that are compared code by code.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// What is rare. A run dereferences to it.
    pub summary: Summary,
    /// The codes at the converter's inputs at every trigger of a scan, in order: four make a frame.
    pub scans: Vec<Scan>,
    /// How the motor was driven when each scan period ended, as the plant saw it.
    pub drives: Vec<MotorDrive>,
    /// Whether the object moved relative to the finger at each scan.
    pub slipping: Vec<bool>,
    /// Slow frames, as they came up the line.
    pub slows: Vec<Slow>,
    /// Every byte that came up the line: what `tenax monitor` would have read.
    pub line: Vec<u8>,
}

impl Deref for Run {
    type Target = Summary;

    fn deref(&self) -> &Summary {
        &self.summary
    }
}

impl DerefMut for Run {
    fn deref_mut(&mut self) -> &mut Summary {
        &mut self.summary
    }
}

impl Summary {
    /// The network, each time it was asked for.
    pub fn networks(&self) -> impl Iterator<Item = &NetworkState> {
        self.answers.iter().filter_map(|(_, answer)| match answer {
            Answer::Network(network) => Some(network),
            _ => None,
        })
    }

    /// The vibration motor is driven so from this frame on.
    fn vibrates(&mut self, frame: u32, duty: Duty) {
        if self.feedback.last().map_or(Duty::default(), |last| last.1) != duty {
            self.feedback.push((frame, duty));
        }
    }

    /// Puts a message where it belongs.
    fn take(&mut self, message: Up, recorder: &mut dyn Recorder) {
        match message {
            Up::Hello { after, .. } => self.starts.push(after),
            Up::Slow(slow) => recorder.slow(&slow),
            Up::Event(event) => self.events.push(event),
            Up::Counters(counters) => self.counters = counters,
            Up::Answer { of, answer, .. } => self.answers.push((of, answer)),
            Up::Saved { frame, kept } => self.saved.push((frame, kept)),
            _ => {}
        }
    }
}

/// What was done to the flash.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlashUse {
    /// Words programmed.
    pub words: u64,
    /// Sectors erased.
    pub erases: u64,
}
