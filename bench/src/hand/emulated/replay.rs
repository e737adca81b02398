//! Whether the host's build of the logic and of the bus's end, given what an image was given, says the same, byte for byte.

use std::collections::VecDeque;
use std::fmt;

use serde::Serialize;
use tenax_hal_shim::channel::SCANS_PER_FRAME;
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::schedule::{Job, slot_of};
use tenax_hal_shim::wire::{Event as Told, Identity, Received, Receiver, Slow, Up};
use tenax_logic::device::Device;
use tenax_logic::emg::model::EmgModel;
use tenax_palm::bus::{Chip, FRAME_MAX};
use tenax_palm::finger::Finger;

use super::world::{Event, Log};
use crate::board::kept;
use crate::board::simulated::downlink::Downlink;

/// Bytes of the image's ring.
const RING: u32 = 256;

/// How much was compared, and where it first differs.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Agreement {
    pub ticks: u32,
    pub slows: usize,
    pub events: usize,
    /// Answers to the palm, and their bytes.
    pub answers: usize,
    pub bytes: usize,
    /// Answers that the image left out because they would have come too late.
    pub left_out: usize,
    pub commands: usize,
    difference: Option<String>,
}

impl Agreement {
    /// Of what an image with this number, and calibrated to this wearer, was given and did.
    pub fn of(log: &Log, chip: Chip, wearer: Option<&EmgModel>) -> Self {
        let mut replay = Replay::new(log, chip, wearer);
        for event in &log.events {
            if replay.agreement.difference.is_none() {
                replay.step(*event);
            }
        }
        replay.conclude()
    }

    /// Whether nothing differs.
    pub const fn holds(&self) -> bool {
        self.difference.is_none()
    }
}

impl fmt::Display for Agreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(difference) = &self.difference {
            return write!(f, "DIFFERS: {difference}");
        }
        let Self { ticks, slows, events, answers, bytes, left_out, .. } = self;
        write!(
            f,
            "{ticks} ticks, {slows} slow frames, {events} events; {answers} answers of {bytes} bytes, equal; "
        )?;
        write!(f, "{left_out} answers left out")
    }
}

/// The host's fingertip in the image's place.
struct Replay<'a> {
    log: &'a Log,
    device: Device,
    end: Finger,
    down: Downlink,
    /// Messages that came up the image's line, with their frames.
    messages: VecDeque<(Received<Up>, &'a [u8])>,
    slows: Vec<Slow>,
    events: Vec<Told>,
    has_joined: bool,
    heard: usize,
    ring: u32,
    sent: usize,
    agreement: Agreement,
}

impl<'a> Replay<'a> {
    fn new(log: &'a Log, chip: Chip, wearer: Option<&EmgModel>) -> Self {
        let mut device = kept::device(false, wearer);
        let _about = device.start(Identity { chip, ..Identity::default() });
        let frames = log.line.split_inclusive(|&byte| byte == 0);
        let messages = frames.filter_map(|frame| {
            let mut receiver = Receiver::new();
            let received = frame.iter().find_map(|&byte| receiver.push::<Up>(byte))?;
            Some((received.ok()?, frame))
        });
        Self {
            log,
            device,
            end: Finger::new(chip),
            down: Downlink::default(),
            messages: messages.collect(),
            slows: Vec::new(),
            events: Vec::new(),
            has_joined: false,
            heard: 0,
            ring: 0,
            sent: 0,
            agreement: Agreement::default(),
        }
    }

    fn differs(&mut self, what: String) {
        self.agreement.difference.get_or_insert(what);
    }

    fn step(&mut self, event: Event) {
        match event {
            Event::Tick => self.tick(),
            Event::Told { at_us } => self.end.ticked(self.device.fingertip_mut(), at_us),
            Event::Hear { at_us, to } => self.hear(at_us, to),
            Event::Said { number } => self.said(number),
            Event::Command => match self.down.command(self.agreement.ticks) {
                Some(command) => {
                    let _answer = self.device.command(&command);
                    self.agreement.commands += 1;
                }
                None => self.differs("the image took a command that nobody sent".to_owned()),
            },
        }
    }

    fn tick(&mut self) {
        let sequence = self.agreement.ticks;
        let first = sequence as usize * SCANS_PER_FRAME;
        let Some(scans) = self.log.scans.get(first..).and_then(|rest| rest.first_chunk::<SCANS_PER_FRAME>())
        else {
            return self.differs(format!("tick {sequence} has no scans"));
        };
        self.agreement.ticks += 1;
        self.device.button(false);
        let frame = Frame::from_scans(sequence, scans);
        self.device.tick(&frame);
        while let Some(message) = self.device.next_message() {
            match message {
                Up::Slow(slow) => self.slows.push(slow),
                Up::Event(event) => self.events.push(event),
                _ => {}
            }
        }
        if frame.slot() == slot_of(Job::Save) {
            self.device.slow_frame_passed();
        }
    }

    fn said(&mut self, number: u16) {
        while let Some((received, frame)) = self.messages.pop_front() {
            if received.sequence == number {
                self.end.note(&received.message);
                self.end.post(if self.has_joined { frame } else { &[] });
                return;
            }
        }
        // The last message is on its way when the run ends.
    }

    fn hear(&mut self, at_us: u32, to: u32) {
        let count = (to + RING - self.ring) % RING;
        self.ring = to % RING;
        let mut out = [0; FRAME_MAX];
        for _ in 0..count {
            let Some(&byte) = self.log.kept.heard.get(self.heard) else {
                return self.differs(format!("the image read {} bytes more than came", self.heard));
            };
            self.heard += 1;
            let Some(answer) = self.end.hear(byte, at_us, &mut out) else { continue };
            self.has_joined = true;
            let answer = &out[..answer.length];
            let rest = &self.log.kept.sent[self.sent..];
            if rest.starts_with(answer) {
                self.sent += answer.len();
                self.agreement.answers += 1;
                self.agreement.bytes += answer.len();
            } else if !answer.starts_with(rest) {
                self.agreement.left_out += 1;
            }
        }
        while let Some(byte) = self.end.line_byte() {
            self.down.take(&[byte]);
        }
    }

    fn conclude(mut self) -> Agreement {
        let left = self.log.kept.sent.len() - self.sent;
        if left > FRAME_MAX {
            self.differs(format!("from byte {} on the image sent what the host does not", self.sent));
        }
        let mut receiver = Receiver::new();
        let came: Vec<Up> =
            self.log.line.iter().filter_map(|&byte| Some(receiver.push::<Up>(byte)?.ok()?.message)).collect();
        let slows: Vec<&Slow> =
            came.iter().filter_map(|up| if let Up::Slow(slow) = up { Some(slow) } else { None }).collect();
        let events: Vec<&Told> =
            came.iter().filter_map(|up| if let Up::Event(event) = up { Some(event) } else { None }).collect();
        if let Some((image, host)) = slows.iter().zip(&self.slows).find(|(image, host)| **image != *host) {
            let what = crate::board::agreement::slow_difference(image, host);
            self.differs(what);
        }
        if let Some((image, host)) = events.iter().zip(&self.events).find(|(image, host)| **image != *host) {
            self.differs(format!("image {image:?}, host {host:?}"));
        }
        (self.agreement.slows, self.agreement.events) = (slows.len(), events.len());
        // The last may be on its way.
        if slows.len() + 2 < self.slows.len() || events.len() > self.events.len() {
            let (host_slows, host_events) = (self.slows.len(), self.events.len());
            let (image_slows, image_events) = (slows.len(), events.len());
            self.differs(format!(
                "image {image_slows} slow frames, {image_events} events; host {host_slows}, {host_events}"
            ));
        }
        self.agreement
    }
}
