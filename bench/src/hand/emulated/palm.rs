//! What goes on around the palm's image, and whether the host's build of the palm, given the same, says the same.

use std::collections::VecDeque;
use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;

use rigless::emulator::{Driver, Host, Settled, Stop};
use rigless::session::Session;
use rigless::soc::Width;
use rigless::time::VirtualNanos;
use serde::Serialize;
use tenax_board_model::nucleo::Nucleo;
use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::wire::{self, Down, Receiver};
use tenax_palm::bus::FRAME_MAX;
use tenax_palm::line::{self, Lines};
use tenax_palm::palm::{Palm, Report};
use tenax_palm::places::Places;
use tenax_serial::link::{Encoder, Inbox, behind};

use super::course::{Course, Kept, STOPS_PER_SCAN};
use super::hub::Hub;
use crate::image::symbols::PalmSymbols;

/// Bytes of each of the image's rings.
const RING: u32 = 512;
/// Stops from one look at its line to the next: 1 ms.
const LINE_STOPS: u64 = 80;

/// A message to a finger's line, as a PC sends it to the palm's.
pub fn to_finger(finger: u8, command: &Down) -> line::Down {
    line::Down::Line { finger, bytes: Encoder::default().frame(command).1.iter().copied().collect() }
}

/// What the image did that its palm saw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Event {
    /// It starts, at this instant, us.
    Start { at_us: u32 },
    /// It reads the bus until its ring stood there, at this instant, us.
    Hear { at_us: u32, to: u32 },
    /// Its palm may speak, at this instant, us.
    Step { at_us: u32 },
    /// It reads its line until that ring stood there.
    Take { to: u32 },
}

/// What it was given and did.
#[derive(Debug, Default)]
pub struct Log {
    events: Vec<Event>,
    /// What went down its line.
    down: Vec<u8>,
    pub kept: Kept,
    /// What it said on its line: when what was reported, s; each finger's line, and the answers in it.
    pub reports: Vec<(f64, Report)>,
    pub said: Vec<(f64, line::Up)>,
    pub lines: Vec<Inbox>,
    pub answers: Vec<u64>,
}

pub struct World {
    /// Its time begins with the first of its steps.
    course: Course,
    pub log: Log,
    symbols: PalmSymbols,
    stops_max: u64,
    start: Option<Event>,
    receiver: Receiver,
    /// Bytes for its line, and from when on, s.
    commands: VecDeque<(f64, Vec<u8>)>,
}

impl World {
    /// The last of `hub`'s images, among so many fingers.
    pub fn new(
        fingers: usize,
        hub: Arc<Hub>,
        symbols: PalmSymbols,
        seconds: f64,
        commands: &[(f64, line::Down)],
    ) -> Self {
        let commands = commands.iter().map(|(at_s, down)| (*at_s, behind::frame(0, down)));
        let log = Log {
            lines: (0..fingers).map(|_| Inbox::default()).collect(),
            answers: vec![0; fingers],
            ..Log::default()
        };
        Self {
            course: Course::new(fingers, hub),
            log,
            symbols,
            // The fingertips' last scan is nobody's to wait for.
            stops_max: ((seconds * f64::from(SCAN_HZ)) as u64 - 1) * STOPS_PER_SCAN + 1,
            start: None,
            receiver: Receiver::new(),
            commands: commands.collect(),
        }
    }

    fn hit(&mut self, address: u64, host: &mut dyn Host) {
        let mut with = |word: u64| host.read(self.symbols.with + 4 * word, Width::W32).unwrap_or(0) as u32;
        let [hear, step, take] = self.symbols.does;
        let event = match address {
            _ if address == hear => Event::Hear { at_us: with(0), to: with(1) },
            _ if address == step => Event::Step { at_us: with(0) },
            _ if address == take => Event::Take { to: with(2) },
            _ => return,
        };
        let start = Event::Start { at_us: with(3) };
        if self.start.replace(start) != Some(start) {
            self.log.events.push(start);
        }
        self.log.events.push(event);
    }

    fn stop(&mut self, session: &mut Session<Nucleo>, stop: Stop) -> Option<VirtualNanos> {
        let did = self.course.did(session, stop.at);
        if self.course.stops.is_multiple_of(LINE_STOPS) {
            self.line(session, stop.at, did.now_ns as f64 / 1e9);
        }
        let given = self.course.meet(did)?;
        self.course.go_on(session, stop.at, given.bytes)
    }

    /// What came up its line, and what is due down.
    fn line(&mut self, session: &mut Session<Nucleo>, now: VirtualNanos, t_s: f64) {
        let Some(line) = session.board_mut().mcu.line(now) else { return };
        while let Some((_, bytes)) = self.commands.pop_front_if(|(at_s, _)| *at_s <= t_s) {
            line.down.extend(&bytes);
            self.log.down.extend(bytes);
        }
        for byte in std::mem::take(&mut line.up) {
            match self.receiver.push::<line::Up>(byte).and_then(Result::ok).map(|received| received.message) {
                Some(line::Up::Line { finger, bytes }) => {
                    let finger = usize::from(finger) - 1;
                    for &byte in &bytes {
                        if let Some(Ok(heard)) = self.log.lines[finger].push(byte) {
                            let answer = matches!(heard.received.message, wire::Up::Answer { .. });
                            self.log.answers[finger] += u64::from(answer);
                        }
                    }
                }
                Some(line::Up::Bus(report)) => self.log.reports.push((t_s, report)),
                Some(said) => self.log.said.push((t_s, said)),
                None => {}
            }
        }
    }
}

impl Driver<Nucleo> for World {
    fn on_settled(&mut self, session: &mut Session<Nucleo>, host: &mut dyn Host, settled: Settled) {
        if let Some(address) = self.course.settled(session, host, settled) {
            self.hit(address, host);
        }
    }

    fn on_stop(
        &mut self,
        session: &mut Session<Nucleo>,
        stop: Stop,
        host: &mut dyn Host,
    ) -> Option<VirtualNanos> {
        if let Some(next) = self.course.between(session, stop.at) {
            return Some(next);
        }
        if let ControlFlow::Break(next) = self.course.begins(stop, !self.log.events.is_empty()) {
            return next;
        }
        if self.course.stops < self.stops_max {
            return self.stop(session, stop);
        }
        self.log.kept = self.course.end(session, stop, host, &self.symbols.stack);
        None
    }
}

/// How much of what the palm said was compared, and where it first differs.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Agreement {
    /// Frames that the host's build says, too, and their bytes.
    pub frames: usize,
    pub bytes: usize,
    difference: Option<String>,
}

impl Agreement {
    /// Of an image that knows these fingers, until it starts anew.
    pub fn of(log: &Log, places: &Places) -> Self {
        let mut agreement = Self::default();
        agreement.difference = agreement.replay(log, places).err();
        agreement
    }

    /// Whether nothing differs.
    pub const fn holds(&self) -> bool {
        self.difference.is_none()
    }

    fn replay(&mut self, log: &Log, places: &Places) -> Result<(), String> {
        let (mut palm, mut lines) = (Palm::new(places, 0), Lines::default());
        let mut has_started = false;
        let (mut heard, mut down) = (Ring::new(&log.kept.heard), Ring::new(&log.down));
        let mut out = [0; FRAME_MAX];
        for event in &log.events {
            match *event {
                Event::Start { .. } if has_started => return Ok(()),
                Event::Start { at_us } => (palm, has_started) = (Palm::new(places, at_us), true),
                Event::Hear { at_us, to } => heard.until(to, |byte| {
                    if let Some(finger) = palm.hear(byte, at_us) {
                        lines.answered(&palm, finger);
                    }
                })?,
                Event::Take { to } => down.until(to, |byte| _ = lines.hear(byte, &mut palm))?,
                Event::Step { at_us } => {
                    let length = palm.step(at_us, &mut out);
                    let rest = &log.kept.sent[self.bytes..];
                    let frame = &out[..length];
                    if rest.starts_with(frame) {
                        self.frames += usize::from(length > 0);
                        self.bytes += length;
                    } else if !frame.starts_with(rest) {
                        return Err(format!(
                            "after {} frames, at {at_us} us, the host says other bytes",
                            self.frames
                        ));
                    }
                }
            }
        }
        let left = log.kept.sent.len() - self.bytes;
        if left > FRAME_MAX {
            return Err(format!("from byte {} on the image said what the host does not", self.bytes));
        }
        Ok(())
    }
}

impl fmt::Display for Agreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.difference {
            Some(difference) => write!(f, "DIFFERS: {difference}"),
            None => write!(f, "{} frames of {} bytes, equal", self.frames, self.bytes),
        }
    }
}

/// Bytes that came, as the image's ring has them.
struct Ring<'a> {
    bytes: std::slice::Iter<'a, u8>,
    place: u32,
}

impl<'a> Ring<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { bytes: bytes.iter(), place: 0 }
    }

    fn until(&mut self, to: u32, mut hear: impl FnMut(u8)) -> Result<(), String> {
        for _ in 0..(to + RING - self.place) % RING {
            hear(*self.bytes.next().ok_or("the image read more bytes than came")?);
        }
        self.place = to;
        Ok(())
    }
}
