//! The fingertip as a device on a line: frames and commands in, drives, messages and records out.
//!
//! The flashed image, the host's board and the comparison of the two share it, so that answers to commands are
//! decided in one place.
//!
//! ```
//! use tenax_hal_shim::frame::Frame;
//! use tenax_hal_shim::motor::MotorDrive;
//! use tenax_hal_shim::wire::{Answer, Down, Received, Up};
//! use tenax_logic::device::Device;
//!
//! let mut device = Device::default();
//! let Up::Answer { answer, .. } = device.command(&Received { sequence: 0, message: Down::Ping }) else { unreachable!() };
//! assert_eq!(answer, Answer::Done);
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
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::schedule::{Job, slot_of};
use tenax_hal_shim::wire::{
    About, Answer, Down, Identity, Last, Received, Refusal, SCHEMA, Senses, Setting, Up,
};
use tenax_hal_shim::words::{Fault, Kept, Line};

use crate::fingertip::Fingertip;
use crate::samples::LastSamples;
use crate::session::Session;
use crate::store::keeper::Keeper;
use crate::store::record::Record;
use crate::stream::Stream;

/// A fingertip with its session, command answers, records and outgoing messages.
#[derive(Clone, Debug)]
pub struct Device {
    fingertip: Fingertip,
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
    /// A device with this fingertip, which has not ticked yet.
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

    /// The fingertip.
    pub const fn fingertip(&self) -> &Fingertip {
        &self.fingertip
    }

    /// The fingertip, for a caller that ticks and measures it: see [`tick`](Self::tick).
    pub const fn fingertip_mut(&mut self) -> &mut Fingertip {
        &mut self.fingertip
    }

    /// Restores a saved record of this kind. Call it before the first tick.
    pub fn restore(&mut self, kept: Kept, payload: &[u8]) {
        self.fingertip.restore(kept, payload);
        self.keeper = self.fingertip.keeper();
    }

    /// The message `About`, which follows the hello. Call it after all records are restored.
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
        // It has room for all of them. `collect` would panic if it had not, and nothing that a frame reaches may.
        let mut settings = Vec::new();
        let all = SettingId::ALL.into_iter().map(|id| self.setting(id));
        all.take_while(|setting| settings.push(*setting).is_ok()).for_each(drop);
        About { identity: self.identity, schema: SCHEMA, frames: self.stream.next(), settings }
    }

    /// Reports a fault that was found outside the logic.
    pub fn report(&mut self, fault: Fault) {
        self.fingertip.report(fault);
    }

    /// Sets whether the button at the hand is down, until the next call.
    pub const fn button(&mut self, is_down: bool) {
        self.fingertip.button(is_down);
    }

    /// Sets whether the motor bridge reports that it has switched itself off, until the next call. Call it once a slow frame.
    pub const fn bridge(&mut self, is_off: bool) {
        self.fingertip.bridge(is_off);
    }

    /// Whether the light at the hand is on: it shows what a calibration asks for, and its result.
    pub fn light(&self) -> bool {
        self.fingertip.light()
    }

    /// Duty of the vibration motor ([`feedback`](crate::feedback)). Call it once a slow frame.
    pub fn feedback(&mut self) -> Duty {
        self.fingertip.feedback()
    }

    /// This start was a reset, not a power-up: no consent follows from it. Call it before the first tick.
    pub const fn was_reset(&mut self) {
        self.fingertip.was_reset();
    }

    /// Takes one frame and gives the motor's drive until the next, 0.5 ms later.
    pub fn tick(&mut self, frame: &Frame) -> MotorDrive {
        let drive = self.fingertip.tick(frame);
        self.sampled(frame);
        drive
    }

    /// Streams the frame's samples if asked, and does the work of a slow frame. Part of [`tick`](Self::tick).
    pub fn sampled(&mut self, frame: &Frame) {
        self.samples.record(frame);
        self.stream.record(frame);
        // After the motor has been driven, so that nothing waits for it.
        if frame.slot() == slot_of(Job::Think) {
            self.fingertip.think(&self.samples);
        }
    }

    /// Carries out a command, and gives the answer to it.
    pub fn command(&mut self, received: &Received<Down>) -> Up {
        let done = self.carry_out(received);
        self.answer(received, done)
    }

    /// The message `Taken` of a command, to be sent before its answer, if frames are streamed.
    #[must_use]
    pub fn taken(&self, received: &Received<Down>) -> Option<Up> {
        let Received { sequence: of, message: command } = *received;
        self.stream.is_raw().then_some(Up::Taken { before: self.stream.next(), of, command })
    }

    /// Carries out a command. Part of [`command`](Self::command).
    ///
    /// # Errors
    /// The reason why it was not carried out; nothing has changed then.
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

    /// The answer to a command with this result. Part of [`command`](Self::command).
    pub fn answer(&mut self, received: &Received<Down>, done: Result<(), Refusal>) -> Up {
        let answer = match (done, received.message) {
            (Err(refusal), _) => Answer::Refused(refusal),
            (Ok(()), Down::Set(Setting { id, .. }) | Down::Get(id)) => SettingId::from_number(id)
                .map_or(Answer::Refused(Refusal::UnknownSetting), |id| Answer::Setting(self.setting(id))),
            (Ok(()), Down::Settings(from)) => {
                let asked = SettingId::ALL.into_iter().filter(|id| id.number() >= from);
                // As many as an answer has room for.
                let mut settings = Vec::new();
                asked
                    .map(|id| self.setting(id))
                    .take_while(|setting| settings.push(*setting).is_ok())
                    .for_each(drop);
                Answer::Settings(settings)
            }
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

    fn setting(&self, id: SettingId) -> Setting {
        Setting { id: id.number(), value: self.fingertip.config().get(id) }
    }

    /// Whether a message waits to be sent.
    pub fn has_message(&self) -> bool {
        self.fingertip.has_slow()
            || self.stream.has_raw()
            || self.stream.wants_senses()
            || self.fingertip.has_event()
    }

    /// Takes the oldest message that waits to be sent. Call it after every tick until it gives None.
    pub fn next_message(&mut self) -> Option<Up> {
        // Moving a slow frame that is not there would cost as much as moving one that is.
        if self.fingertip.has_slow() {
            let slow = self.fingertip.take_slow()?;
            self.session.stir(slow.samples_sum ^ slow.frame);
            return Some(Up::Slow(slow));
        }
        if self.stream.has_raw() {
            return self.stream.take_raw().map(Up::Raw);
        }
        if self.stream.wants_senses() {
            self.stream.gave_senses();
            return Some(Up::Senses(self.senses()));
        }
        if self.fingertip.has_event() {
            return self.fingertip.next_event().map(Up::Event);
        }
        None
    }

    /// The next record to save. Call it once a slow frame and save the result: each record is given once.
    pub fn next_record(&mut self) -> Option<Record> {
        self.fingertip.next_record(&mut self.keeper)
    }

    /// Advances the pauses between saves by a slow frame. Call it once in each.
    pub fn slow_frame_passed(&mut self) {
        self.keeper.pass(FRAMES_PER_SLOW_FRAME.into());
    }
}
