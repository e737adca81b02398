//! What goes on around the palm's image, and whether the host's build of the palm, given the same, says the same.

use std::collections::VecDeque;
use std::fmt;
use std::sync::Arc;

use rigless::emulator::{Driver, Host, Settled, Stop};
use rigless::session::Session;
use rigless::soc::Width;
use rigless::time::VirtualNanos;
use serde::Serialize;
use tenax_board_model::flash::FlashArray;
use tenax_board_model::nucleo::Nucleo;
use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::wire::{self, Down, Receiver};
use tenax_palm::bus::FRAME_MAX;
use tenax_palm::line::{self, Lines};
use tenax_palm::palm::{Palm, Report};
use tenax_palm::places::Places;
use tenax_serial::link::{Encoder, Inbox, behind};

use super::hub::{Did, Hub, STOP_NS};
use super::world::{BOOT_NS, SEEK_NS, STOPS_PER_SCAN, WORD_NS, driver_of, next_burst};
use crate::board::emulated::cost::stack_used;
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
    heard: Vec<u8>,
    sent: Vec<u8>,
    /// What went down its line.
    down: Vec<u8>,
    pub stack_bytes: u64,
    pub instructions_per_s: f64,
    /// What it said on its line: when what was reported, s; each finger's line, and the answers in it.
    pub reports: Vec<(f64, Report)>,
    pub said: Vec<(f64, line::Up)>,
    pub lines: Vec<Inbox>,
    pub answers: Vec<u64>,
}

pub struct World {
    n: usize,
    hub: Arc<Hub>,
    pub log: Log,
    symbols: PalmSymbols,
    flash: FlashArray,
    stops_max: u64,
    /// The first of its steps, and what had been executed then.
    began: Option<(VirtualNanos, u64)>,
    start: Option<Event>,
    stops: u64,
    drivers: Vec<(u64, bool)>,
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
            n: fingers,
            hub,
            log,
            symbols,
            flash: FlashArray::new(WORD_NS),
            // The fingertips' last scan is nobody's to wait for.
            stops_max: ((seconds * f64::from(SCAN_HZ)) as u64 - 1) * STOPS_PER_SCAN + 1,
            began: None,
            start: None,
            stops: 0,
            drivers: Vec::new(),
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
        let (began, _) = self.began?;
        let since = |at: u64| at.saturating_sub(began.0);
        let mut did = Did { now_ns: since(stop.at.0), ..Did::default() };
        did.drivers = std::mem::take(&mut self.drivers).into_iter().map(|(at, on)| (since(at), on)).collect();
        if let Some(end) = session.board_mut().mcu.bus_end(stop.at) {
            let bytes = std::mem::take(&mut end.up);
            self.log.sent.extend(bytes.iter().map(|(_, byte)| byte));
            did.bytes = bytes.into_iter().map(|(at, byte)| (since(at.0), byte)).collect();
        }
        if self.stops.is_multiple_of(LINE_STOPS) {
            self.line(session, stop.at, since(stop.at.0) as f64 / 1e9);
        }
        let given = self.hub.meet(self.n, did)?;
        self.stops += 1;
        let next = VirtualNanos(began.0 + self.stops * STOP_NS);
        if let Some(end) = session.board_mut().mcu.bus_end(stop.at) {
            end.down.extend(given.bytes.into_iter().map(|(at, byte)| (VirtualNanos(began.0 + at), byte)));
        }
        Some(next_burst(session, stop.at, next))
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
        match settled {
            Settled::Hit(hit) => self.hit(hit.address, host),
            Settled::Access { access, .. } => {
                self.drivers.extend(driver_of(&access));
                self.flash.accessed(&access, session, host);
            }
            Settled::Stop(stop) => self.flash.stopped(stop, session, host),
            _ => {}
        }
    }

    fn on_stop(
        &mut self,
        session: &mut Session<Nucleo>,
        stop: Stop,
        host: &mut dyn Host,
    ) -> Option<VirtualNanos> {
        let due = self.began.map(|(began, _)| VirtualNanos(began.0 + self.stops * STOP_NS));
        if let Some(due) = due.filter(|&due| stop.at < due) {
            // A stop for the first byte behind a pause.
            return Some(next_burst(session, stop.at, due));
        }
        if self.began.is_none() {
            if self.log.events.is_empty() {
                let waits = stop.at.0 < BOOT_NS;
                if !waits {
                    self.hub.leave();
                }
                return waits.then_some(VirtualNanos(stop.at.0 + SEEK_NS));
            }
            self.began = Some((stop.at, stop.instruction_count));
        }
        if self.stops >= self.stops_max {
            if let Some(end) = session.board_mut().mcu.bus_end(stop.at) {
                self.log.heard = std::mem::take(&mut end.heard);
            }
            self.log.stack_bytes = stack_used(&self.symbols.stack, host);
            if let Some((began, executed)) = self.began {
                let lasted_s = (stop.at.0 - began.0) as f64 / 1e9;
                self.log.instructions_per_s = (stop.instruction_count - executed) as f64 / lasted_s;
            }
            return None;
        }
        self.stop(session, stop)
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
        let (mut heard, mut down) = (Ring::new(&log.heard), Ring::new(&log.down));
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
                    let rest = &log.sent[self.bytes..];
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
        let left = log.sent.len() - self.bytes;
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
