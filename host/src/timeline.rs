//! When things happened in a run, in seconds.

use tenax_hal_shim::channel::{ARRAY_COUNT, FRAME_HZ, FRAMES_PER_SLOW_FRAME, FSR_COUNT, FSR_SELECT};
use tenax_hal_shim::wire::{Event, EventKind, Slow, TickRecord};
use tenax_hal_shim::words::Cause;

use crate::board::Run;

/// A run's slow frames with times on them.
#[derive(Clone, Copy, Debug)]
pub struct Timeline<'a> {
    slows: &'a [Slow],
    events: &'a [Event],
    zero_s: f64,
}

impl<'a> Timeline<'a> {
    /// The run's timeline; `zero_s` is added to virtual time (a recording has a time of its own).
    #[must_use]
    pub fn new(run: &'a Run, zero_s: f64) -> Self {
        Self { slows: &run.slows, events: &run.events, zero_s }
    }

    /// When the tick of this frame ran, s: when the frame's last scan had been taken.
    #[must_use]
    pub fn time_s(&self, frame: u32) -> f64 {
        self.zero_s + (f64::from(frame) + 1.0) / f64::from(FRAME_HZ)
    }

    /// Every slow frame and when it ended, s.
    pub fn slows(self) -> impl Iterator<Item = (f64, &'a Slow)> {
        self.slows.iter().map(move |slow| (self.time_s(slow.frame), slow))
    }

    /// Every tick and when it ran, s.
    pub fn ticks(self) -> impl Iterator<Item = (f64, &'a TickRecord)> {
        self.slows.iter().flat_map(move |slow| {
            let first = slow.frame.saturating_sub(u32::from(FRAMES_PER_SLOW_FRAME) - 1);
            (first..).map(move |frame| self.time_s(frame)).zip(&slow.ticks)
        })
    }

    /// When S1 spoke: the rising edges, s.
    #[must_use]
    pub fn s1(self) -> Vec<f64> {
        rising(self.ticks().map(|(t, tick)| (t, tick.s1)))
    }

    /// When the network said slip: the rising edges, s.
    #[must_use]
    pub fn network(self) -> Vec<f64> {
        rising(self.ticks().map(|(t, tick)| (t, tick.slips)))
    }

    /// When the array said slip: the rising edges, s. It does so in the third tick after its last element was read.
    #[must_use]
    pub fn array(self) -> Vec<f64> {
        let ticks_before_end = u32::from(FRAMES_PER_SLOW_FRAME) - 3 - ARRAY_COUNT as u32;
        let decided = |slow: &Slow| self.time_s(slow.frame.saturating_sub(ticks_before_end));
        rising(self.slows.iter().map(|slow| (decided(slow), slow.array.slip)))
    }

    /// When S2 spoke: the rising edges, s. A slow frame says only that it did; it does so in the tick that reads the last
    /// of the four quadrants.
    #[must_use]
    pub fn s2(self) -> Vec<f64> {
        let last_quadrant = u32::from(FSR_SELECT) + FSR_COUNT as u32 - 1;
        let ticks_before_end = u32::from(FRAMES_PER_SLOW_FRAME) - 1 - last_quadrant;
        let decided = |slow: &Slow| self.time_s(slow.frame.saturating_sub(ticks_before_end));
        rising(self.slows.iter().map(|slow| (decided(slow), slow.s2)))
    }

    /// When a muscle became active, s: the tick in which the wearer took over if it was this that changed the mode, else
    /// the end of the slow frame that first says so.
    #[must_use]
    pub fn wearer(self) -> Vec<f64> {
        let edges = rising(self.slows().map(|(t, slow)| (t, slow.wearer_active)));
        let slow_frame_s = f64::from(FRAMES_PER_SLOW_FRAME) / f64::from(FRAME_HZ);
        let taken_over = self.events.iter().filter_map(|event| match event.kind {
            EventKind::Mode { cause: Cause::TakenOver, .. } => Some(self.time_s(event.frame)),
            _ => None,
        });
        let taken_over: Vec<f64> = taken_over.collect();
        let exact = |end: f64| taken_over.iter().copied().find(|&t| t > end - slow_frame_s && t <= end);
        edges.into_iter().map(|end| exact(end).unwrap_or(end)).collect()
    }
}

/// The instants at which something becomes true, the first one included if it is true then.
pub fn rising(states: impl IntoIterator<Item = (f64, bool)>) -> Vec<f64> {
    let mut before = false;
    let mut edges = Vec::new();
    for (t, now) in states {
        if now && !before {
            edges.push(t);
        }
        before = now;
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_where_it_becomes_true() {
        let states = [true, true, false, true, false].map(|on| on);
        let timed = states.iter().enumerate().map(|(n, &on)| (n as f64, on));
        assert_eq!(rising(timed), [0.0, 3.0]);
        assert!(rising([]).is_empty());
    }
}
