//! Telemetry of every tick: the records of a slow frame, and the events in between.

use heapless::Deque;
use tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME;
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::wire::{Event, EventKind, SamplesSum, TickRecord};
use tenax_hal_shim::words::{Cause, Fault, GripMode, MotorStop};

use crate::health::Change;

const EVENTS: usize = 32;

#[derive(Clone, Debug, Default)]
pub struct Journal {
    frame: u32,
    ticks: [TickRecord; FRAMES_PER_SLOW_FRAME as usize],
    samples: SamplesSum,
    events: Deque<Event, EVENTS>,
    events_lost: u16,
    lost: bool,
}

impl Journal {
    pub fn begin(&mut self, frame: &Frame) {
        self.frame = frame.sequence;
        if frame.slot() == 0 {
            self.ticks = Default::default();
        }
        if frame.valid {
            self.samples.update(frame);
        }
    }

    pub const fn frame(&self) -> u32 {
        self.frame
    }

    pub fn tick(&mut self, place: u8, record: TickRecord) {
        if let Some(slot) = self.ticks.get_mut(usize::from(place)) {
            *slot = record;
        }
    }

    pub fn last_tick(&self) -> Option<TickRecord> {
        self.ticks.get(self.frame as usize % self.ticks.len()).copied()
    }

    /// Ticks of the slow frame, and the checksum ([`SamplesSum`]) of their samples.
    pub fn take_slow(&mut self) -> ([TickRecord; FRAMES_PER_SLOW_FRAME as usize], u32) {
        (self.ticks, self.samples.take())
    }

    pub fn mode(&mut self, from: GripMode, to: GripMode, cause: Cause) {
        self.event(EventKind::Mode { from, to, cause });
    }

    pub fn fault(&mut self, fault: Fault) {
        self.event(EventKind::Fault(fault));
    }

    /// A full queue drops and counts the event. Not inlined: events are rare.
    #[inline(never)]
    pub fn event(&mut self, kind: EventKind) {
        self.lost |= matches!(
            kind,
            EventKind::Fault(Fault::SensorLost { .. } | Fault::CapabilityLost(_))
                | EventKind::Motor(Some(MotorStop::Hot | MotorStop::BridgeOff))
        );
        if self.events.push_back(Event { frame: self.frame, kind }).is_err() {
            self.events_lost = self.events_lost.saturating_add(1);
        }
    }

    pub const fn take_lost(&mut self) -> bool {
        core::mem::replace(&mut self.lost, false)
    }

    pub fn has_event(&self) -> bool {
        !self.events.is_empty() || self.events_lost > 0
    }

    /// After the last event, the number of dropped ones, if any.
    pub fn next_event(&mut self) -> Option<Event> {
        self.events.pop_front().or_else(|| {
            let lost = core::mem::take(&mut self.events_lost);
            (lost > 0).then_some(Event { frame: self.frame, kind: EventKind::EventsLost(lost) })
        })
    }
}

pub fn report(journal: &mut Journal, channel: usize, change: Option<Change>) {
    let channel = channel as u8;
    match change {
        Some(Change::Lost(reason)) => journal.fault(Fault::SensorLost { channel, reason }),
        Some(Change::Back) => journal.fault(Fault::SensorBack { channel }),
        None => {}
    }
}
