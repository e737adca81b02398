//! When things happened in a run, in seconds.

use std::ops::RangeInclusive;

use tenax_hal_shim::channel::{FRAME_HZ, FRAMES_PER_SLOW_FRAME};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::wire::{Event, EventKind, Slow, TickRecord};
use tenax_hal_shim::words::Cause;

use crate::board::Recorder;
use crate::scorer::Verdict;

/// A stretch of frames in which something was said. It goes on where it has no end.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    from: u32,
    to: Option<u32>,
    by_wearer: bool,
}

type Said = Vec<Stretch>;

#[derive(Clone, Debug, Default)]
pub struct Timeline {
    /// Added to virtual time, s.
    pub zero_s: f64,
    said: [Said; DetectorId::COUNT],
    believed: [Said; DetectorId::COUNT],
    acted: [Said; DetectorId::COUNT],
    /// The last frame of each slow frame, and whether a muscle was active in it.
    active: Vec<(u32, bool)>,
}

impl Recorder for Timeline {
    fn slow(&mut self, slow: &Slow) {
        for (frame, tick) in ticks(slow) {
            let by_set = [&mut self.said, &mut self.believed, &mut self.acted];
            for (said, set) in by_set.into_iter().zip([tick.said, tick.believed, tick.acted]) {
                push(said, set, frame, slow.wearer_active);
            }
        }
        self.active.push((slow.frame, slow.wearer_active));
    }
}

fn push(all: &mut [Said; DetectorId::COUNT], set: DetectorSet, frame: u32, by_wearer: bool) {
    for (said, id) in all.iter_mut().zip(DetectorId::ALL) {
        match (said.last_mut().filter(|last| last.to.is_none()), set.contains(id)) {
            (None, true) => said.push(Stretch { from: frame, to: None, by_wearer }),
            (Some(last), false) => last.to = Some(frame),
            _ => {}
        }
    }
}

impl Timeline {
    pub fn new(zero_s: f64) -> Self {
        Self { zero_s, ..Self::default() }
    }

    pub fn time_s(&self, frame: u32) -> f64 {
        self.zero_s + frame_end_s(frame)
    }

    /// When a detector began to say slip or to warn of it, believed or not, s.
    pub fn said(&self, id: DetectorId) -> Vec<f64> {
        self.times_s(&self.said[id as usize])
    }

    /// When it began to say so and was believed, s.
    pub fn believed(&self, id: DetectorId) -> Vec<f64> {
        self.times_s(&self.believed[id as usize])
    }

    /// The stretches in which it said so and was believed, for the [scorer](crate::scorer).
    pub fn verdicts(&self, id: DetectorId) -> Vec<Verdict> {
        self.stretches(&self.believed[id as usize])
    }

    pub fn verdicts_said(&self, id: DetectorId) -> Vec<Verdict> {
        self.stretches(&self.said[id as usize])
    }

    /// When the reflex began to act on it, s.
    pub fn acted(&self, id: DetectorId) -> Vec<f64> {
        self.times_s(&self.acted[id as usize])
    }

    /// When a muscle became active, s: the tick in which the wearer took over, else the end of the slow frame that first says so.
    pub fn wearer(&self, events: &[Event]) -> Vec<f64> {
        let slow_frame_s = f64::from(FRAMES_PER_SLOW_FRAME) / f64::from(FRAME_HZ);
        let taken_over = events.iter().filter_map(|event| match event.kind {
            EventKind::Mode { cause: Cause::TakenOver, .. } => Some(self.time_s(event.frame)),
            _ => None,
        });
        let taken_over: Vec<f64> = taken_over.collect();
        let exact = |end: f64| taken_over.iter().copied().find(|&t| t > end - slow_frame_s && t <= end);
        let mut before = false;
        let begins =
            self.active.iter().filter(|(_, active)| !std::mem::replace(&mut before, *active) && *active);
        begins.map(|(frame, _)| self.time_s(*frame)).map(|end| exact(end).unwrap_or(end)).collect()
    }

    /// Part of the slow frames within a span in which a muscle was active.
    pub fn active_part(&self, span_s: RangeInclusive<f64>) -> f64 {
        let within = self.active.iter().filter(|(frame, _)| span_s.contains(&self.time_s(*frame)));
        let (all, active) = within.fold((0u32, 0u32), |(all, sum), own| (all + 1, sum + u32::from(own.1)));
        f64::from(active) / f64::from(all.max(1))
    }

    fn stretches(&self, said: &Said) -> Vec<Verdict> {
        let to_s = |end: Option<u32>| end.map_or(f64::INFINITY, |frame| self.time_s(frame));
        let verdict = |own: &Stretch| Verdict {
            from_s: self.time_s(own.from),
            to_s: to_s(own.to),
            by_wearer: own.by_wearer,
        };
        said.iter().map(verdict).collect()
    }

    fn times_s(&self, said: &Said) -> Vec<f64> {
        said.iter().map(|own| self.time_s(own.from)).collect()
    }
}

pub(crate) fn frame_end_s(frame: u32) -> f64 {
    (f64::from(frame) + 1.0) / f64::from(FRAME_HZ)
}

pub(crate) fn ticks(slow: &Slow) -> impl Iterator<Item = (u32, &TickRecord)> {
    let first = slow.frame.saturating_sub(u32::from(FRAMES_PER_SLOW_FRAME) - 1);
    (first..).zip(&slow.ticks)
}
