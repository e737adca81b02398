//! When things happened in a run, in seconds.

use tenax_hal_shim::channel::{FRAME_HZ, FRAMES_PER_SLOW_FRAME, FSR_COUNT, FSR_SELECT};
use tenax_hal_shim::wire::{Event, EventKind, Slow, TickRecord};
use tenax_hal_shim::words::Cause;
use tenax_logic::array::detector::VERDICT_PLACE;

use crate::board::Recorder;

/// When each detector began to speak in a run, gathered while it goes.
#[derive(Clone, Debug, Default)]
pub struct Timeline {
    zero_s: f64,
    s1: Edges,
    s2: Edges,
    network: Edges,
    array: Edges,
    wearer: Edges,
}

impl Recorder for Timeline {
    fn slow(&mut self, slow: &Slow) {
        for (frame, tick) in ticks(slow) {
            self.s1.push(frame, tick.s1);
            self.network.push(frame, tick.slips);
        }
        self.s2.push(s2_frame(slow), slow.s2);
        self.array.push(array_frame(slow), slow.array.slip);
        self.wearer.push(slow.frame, slow.wearer_active);
    }
}

impl Timeline {
    /// Of a run that has not begun; `zero_s` is added to virtual time (a recording has a time of its own).
    #[must_use]
    pub fn new(zero_s: f64) -> Self {
        Self { zero_s, ..Self::default() }
    }

    /// What is added to virtual time, s.
    #[must_use]
    pub const fn zero_s(&self) -> f64 {
        self.zero_s
    }

    /// When the tick of this frame ran, s: when the frame's last scan had been taken.
    #[must_use]
    pub fn time_s(&self, frame: u32) -> f64 {
        self.zero_s + frame_end_s(frame)
    }

    /// When S1 spoke: the rising edges, s.
    #[must_use]
    pub fn s1(&self) -> Vec<f64> {
        self.times_s(&self.s1)
    }

    /// When the network said slip: the rising edges, s.
    #[must_use]
    pub fn network(&self) -> Vec<f64> {
        self.times_s(&self.network)
    }

    /// When the array said slip: the rising edges, s. It does so in the tick of its last share.
    #[must_use]
    pub fn array(&self) -> Vec<f64> {
        self.times_s(&self.array)
    }

    /// When S2 spoke: the rising edges, s. A slow frame says only that it did; it does so in the tick that reads the last
    /// of the four quadrants.
    #[must_use]
    pub fn s2(&self) -> Vec<f64> {
        self.times_s(&self.s2)
    }

    /// When a muscle became active, s: the tick in which the wearer took over if it was this that changed the mode, else
    /// the end of the slow frame that first says so. `events` are the run's.
    #[must_use]
    pub fn wearer(&self, events: &[Event]) -> Vec<f64> {
        let slow_frame_s = f64::from(FRAMES_PER_SLOW_FRAME) / f64::from(FRAME_HZ);
        let taken_over = events.iter().filter_map(|event| match event.kind {
            EventKind::Mode { cause: Cause::TakenOver, .. } => Some(self.time_s(event.frame)),
            _ => None,
        });
        let taken_over: Vec<f64> = taken_over.collect();
        let exact = |end: f64| taken_over.iter().copied().find(|&t| t > end - slow_frame_s && t <= end);
        self.times_s(&self.wearer).into_iter().map(|end| exact(end).unwrap_or(end)).collect()
    }

    fn times_s(&self, edges: &Edges) -> Vec<f64> {
        edges.frames.iter().map(|&frame| self.time_s(frame)).collect()
    }
}

/// When the tick of a frame ran, s of virtual time.
pub(crate) fn frame_end_s(frame: u32) -> f64 {
    (f64::from(frame) + 1.0) / f64::from(FRAME_HZ)
}

/// A slow frame's ticks, each with its frame.
pub(crate) fn ticks(slow: &Slow) -> impl Iterator<Item = (u32, &TickRecord)> {
    let first = slow.frame.saturating_sub(u32::from(FRAMES_PER_SLOW_FRAME) - 1);
    (first..).zip(&slow.ticks)
}

/// The frame in whose tick the array's detector spoke.
fn array_frame(slow: &Slow) -> u32 {
    let ticks_before_end = u32::from(FRAMES_PER_SLOW_FRAME) - 3 - ARRAY_COUNT as u32;
    slow.frame.saturating_sub(ticks_before_end)
}

/// The frame in whose tick S2 was judged.
fn s2_frame(slow: &Slow) -> u32 {
    let last_quadrant = u32::from(FSR_SELECT) + FSR_COUNT as u32 - 1;
    let ticks_before_end = u32::from(FRAMES_PER_SLOW_FRAME) - 1 - last_quadrant;
    slow.frame.saturating_sub(ticks_before_end)
}

/// The frames in which something becomes true, the first one included if it is true then.
#[derive(Clone, Debug, Default)]
struct Edges {
    before: bool,
    frames: Vec<u32>,
}

impl Edges {
    fn push(&mut self, frame: u32, now: bool) {
        if now && !self.before {
            self.frames.push(frame);
        }
        self.before = now;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_where_it_becomes_true() {
        let mut edges = Edges::default();
        for (frame, on) in (0..).zip([true, true, false, true, false]) {
            edges.push(frame, on);
        }
        assert_eq!(edges.frames, [0, 3]);
        assert!(Edges::default().frames.is_empty());
    }
}
