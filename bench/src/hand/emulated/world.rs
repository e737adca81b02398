//! What goes on around one image of a hand, and what it does to its end of the bus, in order.

use std::ops::ControlFlow;
use std::sync::Arc;

use rigless::emulator::{Driver, Host, Settled, Stop};
use rigless::mcu::Operate;
use rigless::session::Session;
use rigless::soc::Width;
use rigless::time::VirtualNanos;
use tenax_board_model::nucleo::Nucleo;
use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::frame::{Scan, scan_of_pins};
use tenax_hal_shim::wire::{Counters, Receiver, Up};

use super::course::{Course, Kept, STOPS_PER_SCAN};
use super::hub::Hub;
use crate::board::emulated::wires::Wires;
use crate::image::symbols::Symbols;

/// The port of the bus, and its interrupt at the end of an answer.
const USART1_CR1: u64 = 0x4001_100C;
const CR1_TCIE: u64 = 1 << 6;

/// What an image did that its end of the bus, or its logic, saw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A tick of the logic.
    Tick,
    /// It takes a command.
    Command,
    /// It reads what came until its ring stood there, at this instant, us.
    Hear { at_us: u32, to: u32 },
    /// It tells its end of a tick, whose frame ended then, us.
    Told { at_us: u32 },
    /// It sends the message of this number up its line.
    Said { number: u16 },
}

/// What an image was given and did.
#[derive(Debug, Default)]
pub struct Log {
    pub scans: Vec<Scan>,
    pub events: Vec<Event>,
    /// What came up its own line.
    pub line: Vec<u8>,
    pub kept: Kept,
}

impl Log {
    /// The last counters that came up its line.
    pub fn counters(&self) -> Counters {
        let mut receiver = Receiver::new();
        let messages = self.line.iter().filter_map(|&byte| receiver.push::<Up>(byte)?.ok());
        let counters = messages.filter_map(|received| match received.message {
            Up::Counters(counters) => Some(counters),
            _ => None,
        });
        counters.last().unwrap_or_default()
    }
}

pub struct World {
    course: Course,
    pub log: Log,
    scans: usize,
    pulses: u64,
    symbols: Symbols,
    /// From then on its next answer's end is lost.
    stuck_ns: Option<u64>,
}

impl World {
    pub fn new(n: usize, hub: Arc<Hub>, symbols: Symbols, seconds: f64, stuck_s: Option<f64>) -> Self {
        Self {
            course: Course::new(n, hub),
            log: Log::default(),
            scans: (seconds * f64::from(SCAN_HZ)) as usize,
            pulses: 0,
            symbols,
            stuck_ns: stuck_s.map(|at_s| (at_s * 1e9) as u64),
        }
    }

    fn hit(&mut self, address: u64, host: &mut dyn Host) {
        let mut does =
            |word: u64| host.read(self.symbols.bus_does + 4 * word, Width::W32).unwrap_or(0) as u32;
        let [hear, told, said] = self.symbols.bus;
        let event = match address {
            _ if address == self.symbols.tick => Event::Tick,
            _ if address == self.symbols.command => Event::Command,
            _ if address == hear => Event::Hear { at_us: does(0), to: does(1) },
            _ if address == told => Event::Told { at_us: does(2) },
            _ if address == said => Event::Said { number: does(3) as u16 },
            _ => return,
        };
        if self.course.has_begun() {
            self.log.events.push(event);
        }
    }

    /// Comes to a stop with the others. None when it is over.
    fn stop(&mut self, session: &mut Session<Nucleo>, stop: Stop, pulse: bool) -> Option<VirtualNanos> {
        let now_ns = self.course.since(stop.at.0);
        if self.stuck_ns.is_some_and(|from| now_ns >= from) && self.course.is_on() {
            let mcu = &mut session.board_mut().mcu;
            let control = mcu.peek(stop.at, USART1_CR1, Width::W32).unwrap_or(0);
            let lost = mcu.write(stop.at, USART1_CR1, Width::W32, control & !CR1_TCIE);
            self.stuck_ns = self.stuck_ns.filter(|_| lost.is_err());
        }
        let mut did = self.course.did(session, stop.at);
        let mut wires = Wires::new(&mut session.board_mut().mcu, stop.at);
        if self.course.stops.is_multiple_of(STOPS_PER_SCAN) {
            did.drive = wires.motor().ok();
        }
        let given = self.course.meet(did)?;
        if let Some(codes) = given.codes {
            let scan = scan_of_pins(&codes, wires.select());
            self.log.scans.push(scan);
            wires.put(&scan);
            wires.button(false);
        }
        if pulse {
            wires.trigger();
        }
        self.course.go_on(session, stop.at, given.bytes)
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
        let pulses = session.board_mut().mcu.trigger_pulses(stop.at);
        let pulse = pulses > self.pulses;
        self.pulses = pulses;
        if let ControlFlow::Break(next) = self.course.begins(stop, pulse) {
            return next;
        }
        if self.log.scans.len() < self.scans {
            return self.stop(session, stop, pulse);
        }
        if let Some(line) = session.board_mut().mcu.line(stop.at) {
            self.log.line = std::mem::take(&mut line.up);
        }
        self.log.kept = self.course.end(session, stop, host, &self.symbols.stack);
        None
    }
}
