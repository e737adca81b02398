//! The boards that a plant can be connected to, and the record of a run. A [`Recorder`] hears of what comes 80 times a second or more,
//! the [`Summary`] has what is rare, and a [`Run`] is the recorder that keeps everything.

#[cfg(feature = "host")]
pub mod agreement;
#[cfg(feature = "emulator")]
pub mod emulated;
pub mod hash;
pub mod kept;
pub mod recorder;
pub mod simulated;

use std::ops::{Deref, DerefMut};

use tenax_frames::link::Inbox;
use tenax_hal_shim::frame::Scan;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{Answer, Counters, Down, Event, NetworkState, Received, Slow, Up};
use tenax_hal_shim::words::{Fault, Kept};
use tenax_logic::emg::model::EmgModel;

pub use recorder::Recorder;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TickCost {
    pub count: u64,
    pub instructions_mean: f64,
    pub instructions_max: u64,
    pub instructions_per_s: f64,
}

#[derive(Clone, Debug, Default)]
pub struct Summary {
    pub virtual_s: f64,
    pub wall_s: f64,
    pub trusts_line: bool,
    /// Commands that the logic took, each with the sequence number of the frame before whose tick it did.
    pub taken: Vec<(u32, Received<Down>)>,
    pub events: Vec<Event>,
    pub answers: Vec<(u16, Answer)>,
    /// Records, each with the sequence number of the last frame before.
    pub saved: Vec<(u32, Kept)>,
    pub feedback: Vec<(u32, Duty)>,
    pub starts: Vec<Option<Fault>>,
    pub counters: Counters,
    pub messages_missed: u64,
    pub bad_frames: u64,
    pub line_bytes: usize,
    /// None where instructions cannot be counted.
    pub tick_cost: Option<TickCost>,
    /// The deepest that the stack was, bytes. None where it cannot be measured.
    pub stack_bytes: Option<u64>,
    pub flash: FlashUse,
    pub calibrated: Option<EmgModel>,
}

/// Everything of a run, a gigabyte an hour: for short runs that are compared code by code.
#[derive(Clone, Debug, Default)]
pub struct Run {
    pub summary: Summary,
    pub scans: Vec<Scan>,
    pub drives: Vec<MotorDrive>,
    pub slows: Vec<Slow>,
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
    pub fn networks(&self) -> impl Iterator<Item = &NetworkState> {
        self.answers.iter().filter_map(|(_, answer)| match answer {
            Answer::Network(network) => Some(network),
            _ => None,
        })
    }

    fn vibrates(&mut self, frame: u32, duty: Duty) {
        if self.feedback.last().map_or(Duty::default(), |last| last.1) != duty {
            self.feedback.push((frame, duty));
        }
    }

    /// Takes the messages in a line's bytes, of events and slow frames those before `frames`.
    pub fn hear(&mut self, inbox: &mut Inbox, bytes: &[u8], frames: u32, recorder: &mut dyn Recorder) {
        self.line_bytes += bytes.len();
        recorder.line(bytes);
        for heard in bytes.iter().filter_map(|&byte| inbox.push(byte)).flatten() {
            match heard.received.message {
                Up::Slow(slow) if slow.frame >= frames => {}
                Up::Event(event) if event.frame >= frames => {}
                message => self.take(message, recorder),
            }
        }
        self.bad_frames = inbox.counts().bad_frames;
        self.messages_missed = inbox.counts().missed;
    }

    pub(crate) fn take(&mut self, message: Up, recorder: &mut dyn Recorder) {
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

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlashUse {
    pub words: u64,
    pub erases: u64,
}
