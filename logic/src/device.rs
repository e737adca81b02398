//! The fingertip as a device on a line: frames and commands in, drives, messages and records out. Firmware and host share it.
//!
//! ```
//! use tenax_hal_shim::frame::Frame;
//! use tenax_hal_shim::motor::MotorDrive;
//! use tenax_logic::device::Device;
//!
//! let mut device = Device::default();
//! // Half a millisecond goes by; its samples were lost.
//! assert_eq!(device.tick(&Frame::lost(0)), MotorDrive::Coast);
//! while let Some(message) = device.next_message() {
//!     println!("{message:?}");
//! }
//! ```

use crate::setting::SettingId;
use heapless::Vec;
use tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME;
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::schedule::{Job, slot_of};
use tenax_hal_shim::wire::{
    About, Answer, Down, Identity, Last, Received, Refusal, SCHEMA, Senses, Setting, Up,
};
use tenax_hal_shim::words::{Kept, Line};

use crate::fingertip::Fingertip;
use crate::samples::LastSamples;
use crate::session::Session;
use crate::store::keeper::Keeper;
use crate::store::record::Record;
use crate::stream::Stream;

/// Slot of the films' slow work: `think` has no time left for it.
const LISTEN_SLOT: u8 = slot_of(Job::Save) + 1;

#[derive(Clone, Debug)]
pub struct Device {
    pub fingertip: Fingertip,
    samples: LastSamples,
    keeper: Keeper,
    session: Session,
    stream: Stream,
    identity: Identity,
}

impl Default for Device {
    fn default() -> Self {
        Self::new(Fingertip::default())
    }
}

impl Device {
    pub fn new(fingertip: Fingertip) -> Self {
        let keeper = fingertip.keeper();
        Self {
            fingertip,
            samples: LastSamples::default(),
            keeper,
            session: Session::default(),
            stream: Stream::default(),
            identity: Identity::default(),
        }
    }

    pub fn restore(&mut self, kept: Kept, payload: &[u8]) {
        self.fingertip.restore(kept, payload);
        self.keeper = self.fingertip.keeper();
    }

    /// Call it after all records are restored.
    #[inline(never)]
    pub fn start(&mut self, identity: Identity) -> Up {
        self.identity = identity;
        if self.fingertip.config().stream_at_start {
            self.stream.start();
        }
        Up::About(self.about())
    }

    #[inline(never)]
    fn about(&self) -> About {
        let settings = self.settings(0);
        About { identity: self.identity, schema: SCHEMA, frames: self.stream.next(), settings }
    }

    pub fn tick(&mut self, frame: &Frame) -> MotorDrive {
        let drive = self.fingertip.tick(frame);
        self.sampled(frame);
        drive
    }

    /// Streaming, and the work of a slow frame, after the motor has been driven.
    pub fn sampled(&mut self, frame: &Frame) {
        self.samples.record(frame);
        self.stream.record(frame);
        // After the drive, so that the motor does not wait.
        if frame.slot() == slot_of(Job::Think) {
            self.fingertip.think(&self.samples);
        }
        if frame.slot() == LISTEN_SLOT {
            self.fingertip.listen();
        }
    }

    pub fn command(&mut self, received: &Received<Down>) -> Up {
        let done = self.carry_out(received);
        self.answer(received, done)
    }

    /// `Taken`, to be sent before the answer of a command while frames are streamed.
    pub fn taken(&self, received: &Received<Down>) -> Option<Up> {
        let Received { sequence: of, message: command } = *received;
        self.stream.raw.then_some(Up::Taken { before: self.stream.next(), of, command })
    }

    pub fn carry_out(&mut self, received: &Received<Down>) -> Result<(), Refusal> {
        match received.message {
            Down::Open { nonce } => self.session.open(nonce, received.sequence)?,
            message if message.reads() => self.session.read(received.sequence),
            _ => self.session.admit(received.sequence, self.fingertip.line() == Line::Trusted)?,
        }
        if let Down::Stream { raw, senses, hold_s } = received.message {
            self.stream.ask(raw, senses, hold_s);
        }
        self.fingertip.command(&received.message)
    }

    pub fn answer(&mut self, received: &Received<Down>, done: Result<(), Refusal>) -> Up {
        let answer = match (done, received.message) {
            (Err(refusal), _) => Answer::Refused(refusal),
            (Ok(()), Down::Set(Setting { id, .. }) | Down::Get(id)) => SettingId::from_number(id)
                .map_or(Answer::Refused(Refusal::UnknownSetting), |id| Answer::Setting(self.setting(id))),
            (Ok(()), Down::Settings(from)) => Answer::Settings(self.settings(from)),
            (Ok(()), Down::Samples) => Answer::Samples(self.samples.in_order()),
            (Ok(()), Down::Hello) => Answer::Nonce(self.session.offer()),
            (Ok(()), Down::About) => Answer::About(self.about()),
            // The image, whose memory outlives a reset, fills in the bytes.
            (Ok(()), Down::Last(from)) => Answer::Last(Last::nothing(from)),
            (Ok(()), Down::Network) => Answer::Network(self.fingertip.network()),
            (Ok(()), _) => Answer::Done,
        };
        Up::Answer { of: received.sequence, frame: self.fingertip.frame(), answer }
    }

    #[inline(never)]
    fn senses(&self) -> Senses {
        let films = self.fingertip.films();
        Senses { frame: self.fingertip.frame(), samples: self.samples.in_order(), films }
    }

    /// As many as fit, from this number on.
    fn settings<const N: usize>(&self, from: u8) -> Vec<Setting, N> {
        // Not `collect`, which could panic.
        let mut settings = Vec::new();
        let asked = SettingId::ALL.into_iter().filter(|id| id.number() >= from).map(|id| self.setting(id));
        asked.take_while(|setting| settings.push(*setting).is_ok()).for_each(drop);
        settings
    }

    fn setting(&self, id: SettingId) -> Setting {
        Setting { id: id.number(), value: self.fingertip.config().get(id) }
    }

    pub fn has_message(&self) -> bool {
        self.fingertip.has_slow()
            || self.stream.raw_is_ready
            || self.stream.senses_are_due
            || self.fingertip.has_event()
    }

    /// Oldest message that waits. Call it after every tick until it gives None.
    pub fn next_message(&mut self) -> Option<Up> {
        // Checked first: moving an absent slow frame costs as much as moving one.
        if self.fingertip.has_slow() {
            let slow = self.fingertip.take_slow()?;
            self.session.stir(slow.samples_sum ^ slow.frame);
            return Some(Up::Slow(slow));
        }
        if self.stream.raw_is_ready {
            return self.stream.take_raw().map(Up::Raw);
        }
        if core::mem::take(&mut self.stream.senses_are_due) {
            return Some(Up::Senses(self.senses()));
        }
        if self.fingertip.has_event() {
            return self.fingertip.next_event().map(Up::Event);
        }
        None
    }

    /// Each record is given once: call it once a slow frame and save the result.
    pub fn next_record(&mut self) -> Option<Record> {
        self.fingertip.next_record(&mut self.keeper)
    }

    /// Call it once a slow frame: it advances the pauses between saves.
    pub fn slow_frame_passed(&mut self) {
        self.keeper.pass(FRAMES_PER_SLOW_FRAME.into());
    }
}
