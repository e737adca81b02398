//! What goes on around one image of a hand, and what it does to its end of the bus, in order.

use std::ops::Range;
use std::sync::Arc;

use rigless::emulator::{Access, AccessKind, Driver, Host, Settled, Stop};
use rigless::mcu::Operate;
use rigless::session::Session;
use rigless::soc::Width;
use rigless::time::VirtualNanos;
use tenax_board_model::flash::FlashArray;
use tenax_board_model::nucleo::Nucleo;
use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::frame::{Scan, scan_of_pins};
use tenax_hal_shim::wire::{Counters, Receiver, Up};

use super::hub::{Did, Hub, SLOT_NS, STOP_NS};
use crate::board::emulated::cost::stack_used;
use crate::board::emulated::wires::Wires;
use crate::image::symbols::Symbols;

/// From one scan to the next.
pub const STOPS_PER_SCAN: u64 = 1_000_000_000 / SCAN_HZ as u64 / STOP_NS;
/// While the timer's phase is not known, every this often it is looked for.
pub const SEEK_NS: u64 = 5_000;
/// An image that has not begun to scan by now never will.
pub const BOOT_NS: u64 = 3_000_000_000;
/// Where the bus's driver is switched, and by which bits: PA12.
const GPIOA_BSRR: u64 = 0x4002_0018;
const DRIVER_ON: u64 = 1 << 12;
const DRIVER_OFF: u64 = 1 << 28;
/// The port of the bus, and its interrupt at the end of an answer.
const USART1_CR1: u64 = 0x4001_100C;
const CR1_TCIE: u64 = 1 << 6;
/// How long a word of the flash takes, ns.
pub const WORD_NS: u64 = 16_000;

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
    /// Bytes that it heard on the bus, and sent.
    pub heard: Vec<u8>,
    pub sent: Vec<u8>,
    /// What came up its own line.
    pub line: Vec<u8>,
    pub stack_bytes: u64,
    pub instructions_per_s: f64,
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
    n: usize,
    hub: Arc<Hub>,
    pub log: Log,
    flash: FlashArray,
    scans: usize,
    pulses: u64,
    /// The stop of the first scan, and what had been executed then.
    began: Option<(VirtualNanos, u64)>,
    stops: u64,
    drivers: Vec<(u64, bool)>,
    stack: Range<u64>,
    tick: u64,
    command: u64,
    bus: [u64; 3],
    bus_does: u64,
    /// From then on its next answer's end is lost.
    stuck_ns: Option<u64>,
}

impl World {
    pub fn new(n: usize, hub: Arc<Hub>, symbols: &Symbols, seconds: f64, stuck_s: Option<f64>) -> Self {
        Self {
            n,
            hub,
            log: Log::default(),
            flash: FlashArray::new(WORD_NS),
            scans: (seconds * f64::from(SCAN_HZ)) as usize,
            pulses: 0,
            began: None,
            stops: 0,
            drivers: Vec::new(),
            stack: symbols.stack.clone(),
            tick: symbols.tick,
            command: symbols.command,
            bus: symbols.bus,
            bus_does: symbols.bus_does,
            stuck_ns: stuck_s.map(|at_s| (at_s * 1e9) as u64),
        }
    }

    fn hit(&mut self, address: u64, host: &mut dyn Host) {
        let mut does = |word: u64| host.read(self.bus_does + 4 * word, Width::W32).unwrap_or(0) as u32;
        let [hear, told, said] = self.bus;
        let event = match address {
            _ if address == self.tick => Event::Tick,
            _ if address == self.command => Event::Command,
            _ if address == hear => Event::Hear { at_us: does(0), to: does(1) },
            _ if address == told => Event::Told { at_us: does(2) },
            _ if address == said => Event::Said { number: does(3) as u16 },
            _ => return,
        };
        if self.began.is_some() {
            self.log.events.push(event);
        }
    }

    /// Comes to a stop with the others. None when it is over.
    fn stop(&mut self, session: &mut Session<Nucleo>, stop: Stop, pulse: bool) -> Option<VirtualNanos> {
        let (began, _) = self.began?;
        let since = |at: u64| at.saturating_sub(began.0);
        let mut did = Did { now_ns: since(stop.at.0), ..Did::default() };
        let mcu = &mut session.board_mut().mcu;
        if self.stuck_ns.is_some_and(|from| did.now_ns >= from)
            && self.drivers.last().is_some_and(|&(_, on)| on)
        {
            let control = mcu.peek(stop.at, USART1_CR1, Width::W32).unwrap_or(0);
            let lost = mcu.write(stop.at, USART1_CR1, Width::W32, control & !CR1_TCIE);
            self.stuck_ns = self.stuck_ns.filter(|_| lost.is_err());
        }
        did.drivers = std::mem::take(&mut self.drivers).into_iter().map(|(at, on)| (since(at), on)).collect();
        if let Some(end) = mcu.bus_end(stop.at) {
            let bytes = std::mem::take(&mut end.up);
            self.log.sent.extend(bytes.iter().map(|(_, byte)| byte));
            did.bytes = bytes.into_iter().map(|(at, byte)| (since(at.0), byte)).collect();
        }
        let mut wires = Wires::new(mcu, stop.at);
        let scans = self.stops.is_multiple_of(STOPS_PER_SCAN);
        if scans {
            did.drive = wires.motor().ok();
        }
        let given = self.hub.meet(self.n, did)?;
        let mut wires = Wires::new(mcu, stop.at);
        if let Some(codes) = given.codes {
            let scan = scan_of_pins(&codes, wires.select());
            self.log.scans.push(scan);
            wires.put(&scan);
            wires.button(false);
        }
        if pulse {
            wires.trigger();
        }
        self.stops += 1;
        let mut next = VirtualNanos(began.0 + self.stops * STOP_NS);
        if let Some(end) = mcu.bus_end(stop.at) {
            end.down.extend(given.bytes.into_iter().map(|(at, byte)| (VirtualNanos(began.0 + at), byte)));
        }
        next = next_burst(session, stop.at, next);
        Some(next)
    }

    fn end(&mut self, session: &mut Session<Nucleo>, stop: Stop, host: &mut dyn Host) {
        let mcu = &mut session.board_mut().mcu;
        if let Some(line) = mcu.line(stop.at) {
            self.log.line = std::mem::take(&mut line.up);
        }
        if let Some(end) = mcu.bus_end(stop.at) {
            self.log.heard = std::mem::take(&mut end.heard);
        }
        self.log.stack_bytes = stack_used(&self.stack, host);
        if let Some((began, executed)) = self.began {
            let lasted_s = (stop.at.0 - began.0) as f64 / 1e9;
            self.log.instructions_per_s = (stop.instruction_count - executed) as f64 / lasted_s;
        }
    }
}

/// No later than where the next bytes begin behind a pause: the port asks for the first of them when it is stopped at.
pub fn next_burst(session: &mut Session<Nucleo>, now: VirtualNanos, next: VirtualNanos) -> VirtualNanos {
    let Some(end) = session.board_mut().mcu.bus_end(now) else { return next };
    let mut last = None;
    for &(begins, _) in &end.down {
        let follows = last.is_some_and(|last: VirtualNanos| begins.0 == last.0 + SLOT_NS);
        last = Some(begins);
        if begins > now && !follows {
            return next.min(begins);
        }
    }
    next
}

/// What a store to the pins' register does to the bus's driver: when, and whether it is on then.
pub fn driver_of(access: &Access) -> Option<(u64, bool)> {
    if access.kind != AccessKind::Write || access.address != GPIOA_BSRR {
        return None;
    }
    let is_on = access.value & DRIVER_ON != 0;
    (is_on || access.value & DRIVER_OFF != 0).then_some((access.virtual_time.0, is_on))
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
        let pulses = session.board_mut().mcu.trigger_pulses(stop.at);
        let pulse = pulses > self.pulses;
        self.pulses = pulses;
        if self.began.is_none() {
            if !pulse {
                let waits = stop.at.0 < BOOT_NS;
                if !waits {
                    self.hub.leave();
                }
                return waits.then_some(VirtualNanos(stop.at.0 + SEEK_NS));
            }
            self.began = Some((stop.at, stop.instruction_count));
        }
        if self.log.scans.len() >= self.scans {
            self.end(session, stop, host);
            return None;
        }
        self.stop(session, stop, pulse)
    }
}
