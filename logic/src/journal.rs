//! Telemetry of every tick: the record of a cycle (slow frame), and the events in between.

use heapless::Deque;
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::wire::{Event, EventKind, SamplesSum, TickRecord};
use tenax_hal_shim::words::{Cause, Fault, GripMode, MotorStop};

use crate::health::Change;

/// Events kept until they are taken: more than all sensors failing at once.
const EVENTS: usize = 32;

/// The fingertip's memory of what it has to tell.
#[derive(Clone, Debug, Default)]
pub struct Journal {
    frame: u32,
    ticks: [TickRecord; tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME as usize],
    samples: SamplesSum,
    events: Deque<Event, EVENTS>,
    events_lost: u16,
    /// Something was lost that the wearer should hear of.
    lost: bool,
}

impl Journal {
    /// A frame begins: what is told from now on happened in it.
    pub fn begin(&mut self, frame: &Frame) {
        self.frame = frame.sequence;
        if frame.slot() == 0 {
            self.ticks = Default::default();
        }
        if frame.valid {
            self.samples.update(frame);
        }
    }

    /// Sequence number of the frame that is being taken.
    #[must_use]
    pub const fn frame(&self) -> u32 {
        self.frame
    }

    /// The tick of this frame.
    pub fn tick(&mut self, place: u8, record: TickRecord) {
        if let Some(slot) = self.ticks.get_mut(usize::from(place)) {
            *slot = record;
        }
    }

    /// The ticks of the slow frame, and the checksum of what they were given; a new one begins.
    pub fn take_slow(
        &mut self,
    ) -> ([TickRecord; tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME as usize], u32) {
        (self.ticks, self.samples.take())
    }

    /// The mode changed.
    pub fn mode(&mut self, from: GripMode, to: GripMode, cause: Cause) {
        self.event(EventKind::Mode { from, to, cause });
    }

    /// Queues an event: this fault began, or what it names works again.
    pub fn fault(&mut self, fault: Fault) {
        self.event(EventKind::Fault(fault));
    }

    /// Queues an event. Not inlined: events are rare, and each caller would carry a copy of the queue's code.
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

    /// Whether a sensor, a sense or the motor was lost since this was last asked.
    pub const fn take_lost(&mut self) -> bool {
        core::mem::replace(&mut self.lost, false)
    }

    /// Whether there is one.
    #[must_use]
    pub fn has_event(&self) -> bool {
        !self.events.is_empty() || self.events_lost > 0
    }

    /// The oldest event not yet taken.
    pub fn next_event(&mut self) -> Option<Event> {
        self.events.pop_front().or_else(|| {
            let lost = core::mem::take(&mut self.events_lost);
            (lost > 0).then_some(Event { frame: self.frame, kind: EventKind::EventsLost(lost) })
        })
    }
}

/// Says what changed with a sensor. A converter has far fewer channels than a `u8` has values.
pub fn report(journal: &mut Journal, channel: usize, change: Option<Change>) {
    let channel = channel as u8;
    match change {
        Some(Change::Lost(reason)) => journal.fault(Fault::SensorLost { channel, reason }),
        Some(Change::Back) => journal.fault(Fault::SensorBack { channel }),
        None => {}
    }
}
