//! Telemetry of every tick: the records of a slow frame, and the events in between.

use heapless::Deque;
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::wire::{Event, EventKind, SamplesSum, TickRecord};
use tenax_hal_shim::words::{Cause, Fault, GripMode, MotorStop};

use crate::health::Change;

/// Events kept until they are taken: more than all sensors failing at once.
const EVENTS: usize = 32;

/// Queue of events, and the tick records of the present slow frame.
#[derive(Clone, Debug, Default)]
pub struct Journal {
    frame: u32,
    ticks: [TickRecord; tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME as usize],
    samples: SamplesSum,
    events: Deque<Event, EVENTS>,
    events_lost: u16,
    /// A sensor, an ability or the motor was lost, which the wearer is to be told.
    lost: bool,
}

impl Journal {
    /// Begins a frame: events from now on have its number.
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
    pub const fn frame(&self) -> u32 {
        self.frame
    }

    /// Stores the record of this frame's tick at its slot, 0 to 24. A larger slot is ignored.
    pub fn tick(&mut self, place: u8, record: TickRecord) {
        if let Some(slot) = self.ticks.get_mut(usize::from(place)) {
            *slot = record;
        }
    }

    /// Returns the ticks of the slow frame and the checksum ([`SamplesSum`]) of their samples, and begins a new
    /// checksum.
    pub fn take_slow(
        &mut self,
    ) -> ([TickRecord; tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME as usize], u32) {
        (self.ticks, self.samples.take())
    }

    /// Queues a change of mode.
    pub fn mode(&mut self, from: GripMode, to: GripMode, cause: Cause) {
        self.event(EventKind::Mode { from, to, cause });
    }

    /// Queues an event: this fault began, or what it names works again.
    pub fn fault(&mut self, fault: Fault) {
        self.event(EventKind::Fault(fault));
    }

    /// Queues an event of the present frame. If the queue is full the event is dropped and counted:
    /// [`next_event`](Self::next_event) reports the number. Not inlined: events are rare, and each caller would carry a
    /// copy of the queue's code.
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

    /// Whether a sensor, an ability or the motor was lost since the last call.
    pub const fn take_lost(&mut self) -> bool {
        core::mem::replace(&mut self.lost, false)
    }

    /// Whether an event waits.
    pub fn has_event(&self) -> bool {
        !self.events.is_empty() || self.events_lost > 0
    }

    /// Takes the oldest event that waits; after the last, the number of dropped events, if there were any. None if
    /// nothing waits.
    pub fn next_event(&mut self) -> Option<Event> {
        self.events.pop_front().or_else(|| {
            let lost = core::mem::take(&mut self.events_lost);
            (lost > 0).then_some(Event { frame: self.frame, kind: EventKind::EventsLost(lost) })
        })
    }
}

/// Queues the fault of a sensor's change, if there is one. A converter has far fewer channels than a `u8` has values.
pub fn report(journal: &mut Journal, channel: usize, change: Option<Change>) {
    let channel = channel as u8;
    match change {
        Some(Change::Lost(reason)) => journal.fault(Fault::SensorLost { channel, reason }),
        Some(Change::Back) => journal.fault(Fault::SensorBack { channel }),
        None => {}
    }
}
