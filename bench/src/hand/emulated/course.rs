//! How an image of a hand goes beside the others, fingertip or palm: where its time begins, where it stops, its end of the bus.

use std::ops::{ControlFlow, Range};
use std::sync::Arc;

use rigless::emulator::{Access, AccessKind, Host, Settled, Stop};
use rigless::session::Session;
use rigless::time::VirtualNanos;
use tenax_board_model::flash::FlashArray;
use tenax_board_model::nucleo::Nucleo;
use tenax_hal_shim::channel::SCAN_HZ;

use super::hub::{Did, Given, Hub, SLOT_NS, STOP_NS};
use crate::board::emulated::cost::stack_used;

/// From one scan to the next.
pub const STOPS_PER_SCAN: u64 = 1_000_000_000 / SCAN_HZ as u64 / STOP_NS;
/// While it is not known where its time begins, that is looked for every this often.
const SEEK_NS: u64 = 5_000;
/// An image that has not begun by now never will.
const BOOT_NS: u64 = 3_000_000_000;
/// Where the bus's driver is switched, and by which bits: PA12.
const GPIOA_BSRR: u64 = 0x4002_0018;
const DRIVER_ON: u64 = 1 << 12;
const DRIVER_OFF: u64 = 1 << 28;
/// How long a word of the flash takes, ns.
const WORD_NS: u64 = 16_000;

/// What is left of any image's run.
#[derive(Debug, Default)]
pub struct Kept {
    /// Bytes that it heard on the bus, and sent.
    pub heard: Vec<u8>,
    pub sent: Vec<u8>,
    pub stack_bytes: u64,
    pub instructions_per_s: f64,
}

pub struct Course {
    /// Its place at the hub.
    n: usize,
    hub: Arc<Hub>,
    flash: FlashArray,
    /// Where its time begins, and what had been executed then.
    began: Option<(VirtualNanos, u64)>,
    pub stops: u64,
    /// What its driver did since the last stop: when, and whether it is on since.
    drivers: Vec<(u64, bool)>,
    sent: Vec<u8>,
}

impl Course {
    pub fn new(n: usize, hub: Arc<Hub>) -> Self {
        let flash = FlashArray::new(WORD_NS);
        Self { n, hub, flash, began: None, stops: 0, drivers: Vec::new(), sent: Vec::new() }
    }

    /// Takes what happened between two stops; the instruction's address, if it was one that is watched.
    pub fn settled(
        &mut self,
        session: &mut Session<Nucleo>,
        host: &mut dyn Host,
        settled: Settled,
    ) -> Option<u64> {
        match settled {
            Settled::Hit(hit) => return Some(hit.address),
            Settled::Access { access, .. } => {
                self.drivers.extend(driver_of(&access));
                self.flash.accessed(&access, session, host);
            }
            Settled::Stop(stop) => self.flash.stopped(stop, session, host),
            _ => {}
        }
        None
    }

    pub const fn has_begun(&self) -> bool {
        self.began.is_some()
    }

    /// Since its time began, ns.
    pub fn since(&self, at_ns: u64) -> u64 {
        at_ns.saturating_sub(self.began.map_or(0, |(began, _)| began.0))
    }

    /// Whether its driver was last switched on since the last stop.
    pub fn is_on(&self) -> bool {
        self.drivers.last().is_some_and(|&(_, on)| on)
    }

    fn next_due(&self) -> Option<VirtualNanos> {
        self.began.map(|(began, _)| VirtualNanos(began.0 + self.stops * STOP_NS))
    }

    /// Where to stop next, if this is a stop for the first byte behind a pause and not one with the others.
    pub fn between(&self, session: &mut Session<Nucleo>, now: VirtualNanos) -> Option<VirtualNanos> {
        let due = self.next_due().filter(|&due| now < due)?;
        Some(next_burst(session, now, due))
    }

    /// Its time has begun, or begins if `now`. Else where to look again; none if it never will.
    pub fn begins(&mut self, stop: Stop, now: bool) -> ControlFlow<Option<VirtualNanos>> {
        if now || self.has_begun() {
            self.began.get_or_insert((stop.at, stop.instruction_count));
            return ControlFlow::Continue(());
        }
        let waits = stop.at.0 < BOOT_NS;
        if !waits {
            self.hub.leave();
        }
        ControlFlow::Break(waits.then_some(VirtualNanos(stop.at.0 + SEEK_NS)))
    }

    /// What it did on the bus since the last stop.
    pub fn did(&mut self, session: &mut Session<Nucleo>, now: VirtualNanos) -> Did {
        let drivers = std::mem::take(&mut self.drivers);
        let drivers = drivers.into_iter().map(|(at, on)| (self.since(at), on)).collect();
        let mut did = Did { now_ns: self.since(now.0), drivers, ..Did::default() };
        if let Some(end) = session.board_mut().mcu.bus_end(now) {
            let bytes = std::mem::take(&mut end.up);
            self.sent.extend(bytes.iter().map(|(_, byte)| byte));
            did.bytes = bytes.into_iter().map(|(at, byte)| (self.since(at.0), byte)).collect();
        }
        did
    }

    /// Comes to a stop with the others. None when it is over.
    pub fn meet(&self, did: Did) -> Option<Given> {
        self.hub.meet(self.n, did)
    }

    /// Hands it the bytes that come, and goes on to the next stop.
    pub fn go_on(
        &mut self,
        session: &mut Session<Nucleo>,
        now: VirtualNanos,
        bytes: Vec<(u64, u8)>,
    ) -> Option<VirtualNanos> {
        let (began, _) = self.began?;
        self.stops += 1;
        if let Some(end) = session.board_mut().mcu.bus_end(now) {
            end.down.extend(bytes.into_iter().map(|(at, byte)| (VirtualNanos(began.0 + at), byte)));
        }
        Some(next_burst(session, now, self.next_due()?))
    }

    /// Its run is over; its stack lies in this range.
    pub fn end(
        &mut self,
        session: &mut Session<Nucleo>,
        stop: Stop,
        host: &mut dyn Host,
        stack: &Range<u64>,
    ) -> Kept {
        let end = session.board_mut().mcu.bus_end(stop.at);
        let lasted_s = self.since(stop.at.0) as f64 / 1e9;
        let executed = stop.instruction_count - self.began.map_or(0, |(_, executed)| executed);
        Kept {
            heard: end.map(|end| std::mem::take(&mut end.heard)).unwrap_or_default(),
            sent: std::mem::take(&mut self.sent),
            stack_bytes: stack_used(stack, host),
            instructions_per_s: executed as f64 / lasted_s,
        }
    }
}

/// No later than where the next bytes begin behind a pause: the port asks for the first of them when it is stopped at.
fn next_burst(session: &mut Session<Nucleo>, now: VirtualNanos, next: VirtualNanos) -> VirtualNanos {
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
fn driver_of(access: &Access) -> Option<(u64, bool)> {
    if access.kind != AccessKind::Write || access.address != GPIOA_BSRR {
        return None;
    }
    let is_on = access.value & DRIVER_ON != 0;
    (is_on || access.value & DRIVER_OFF != 0).then_some((access.virtual_time.0, is_on))
}
