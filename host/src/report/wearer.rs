//! Whether the wearer came first, judged from the pins and not from what the fingertip says of itself.

use std::ops::Range;

use serde::Serialize;
use tenax_hal_shim::channel::{
    CHANNELS, FRAME_HZ, FRAMES_PER_SLOW_FRAME, MYO_EXTENSOR, MYO_FLEXOR, RANK_SWITCH_B, SCANS_PER_FRAME,
    mv_from_sample,
};
use tenax_hal_shim::frame::Scan;
use tenax_hal_shim::front_end::MYO_REST_MV;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::schedule::SCHEDULE;
use tenax_hal_shim::wire::{Slow, TickRecord};
use tenax_hal_shim::words::DriveSource;
use tenax_logic::config::Config;
use tenax_logic::gate::DOMINANCE_PERMILLE;

use crate::board::Recorder;
use crate::timeline::ticks;

/// The wearer's part of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Wearer {
    /// Ticks in which the reflex drove the motor while a myosensor's last reading at the pin was above its threshold.
    pub reflex_while_active: u64,
    /// The longest time from an opening wish at the pins to the motor opening, ms. Null where nobody wished to open.
    pub open_latency_ms: Option<f64>,
    /// When a myosensor first became active, s.
    pub active_first_s: Option<f64>,
    /// Part of the run in which a myosensor was active, hold time included, per mille.
    pub active_permille: u64,
    /// Ticks in which the reflex drove the motor at all: a silence means something only beside this.
    pub reflex_ticks: u64,
}

/// What the two muscles' pins last read, mV above rest.
#[derive(Clone, Copy, Debug, Default)]
struct Muscles([i64; 2]);

impl Muscles {
    /// Takes a frame's scans in.
    fn take(&mut self, frame: usize, scans: &[Scan]) {
        let place = frame % usize::from(FRAMES_PER_SLOW_FRAME);
        let channel = SCHEDULE[place].switch_b.map(usize::from);
        let Some(muscle @ 0..=1) = channel.and_then(|channel| channel.checked_sub(MYO_FLEXOR)) else {
            return;
        };
        let sample: u16 = scans.iter().map(|scan| scan[RANK_SWITCH_B]).sum();
        self.0[usize::from(muscle)] = i64::from(mv_from_sample(sample)) - i64::from(MYO_REST_MV);
    }

    fn active(self, on_mv: i64) -> bool {
        self.0.iter().any(|&mv| mv >= on_mv)
    }

    /// Whether the extensor is active and clearly the stronger one; a shorted pin wishes nothing.
    fn wish_to_open(self, on_mv: i64) -> bool {
        let [flexor, extensor] = self.0;
        let shorted = |mv: i64| mv + i64::from(MYO_REST_MV) > i64::from(CHANNELS[MYO_EXTENSOR].high_mv);
        if shorted(flexor) || shorted(extensor) {
            return false;
        }
        let flexor = if flexor >= on_mv { flexor } else { 0 };
        extensor >= on_mv && extensor * 1_000 > flexor * i64::from(DOMINANCE_PERMILLE)
    }
}

/// Judges a run while it goes.
#[derive(Clone, Debug)]
pub struct Judge {
    on_mv: i64,
    muscles: Muscles,
    /// The scans of the frame that is not yet whole.
    scans: Vec<Scan>,
    /// Frames so far.
    frames: usize,
    active: Frames,
    wish_since: Option<usize>,
    slowest: Option<usize>,
    reflex_ticks: u64,
    reflex_while_active: u64,
    slow_frames: u64,
    active_slow_frames: u64,
}

impl Default for Judge {
    fn default() -> Self {
        Self {
            on_mv: i64::from(Config::default().gate.on_mv),
            muscles: Muscles::default(),
            scans: Vec::with_capacity(SCANS_PER_FRAME),
            frames: 0,
            active: Frames::default(),
            wish_since: None,
            slowest: None,
            reflex_ticks: 0,
            reflex_while_active: 0,
            slow_frames: 0,
            active_slow_frames: 0,
        }
    }
}

impl Recorder for Judge {
    fn scan(&mut self, codes: &Scan, drive: MotorDrive, _slipping: bool) {
        self.scans.push(*codes);
        if self.scans.len() == SCANS_PER_FRAME {
            self.muscles.take(self.frames, &self.scans);
            self.scans.clear();
            self.frame(drive.opens());
        }
    }

    fn slow(&mut self, slow: &Slow) {
        self.slow_frames += 1;
        self.active_slow_frames += u64::from(slow.wearer_active);
        let by_reflex =
            |tick: &TickRecord| tick.source == DriveSource::Reflex && tick.drive != MotorDrive::Coast;
        for (frame, _) in ticks(slow).filter(|(_, tick)| by_reflex(tick)) {
            self.reflex_ticks += 1;
            self.reflex_while_active += u64::from(self.active.contains(frame as usize));
        }
    }
}

impl Judge {
    /// A frame is whole.
    fn frame(&mut self, opens: bool) {
        let frame = self.frames;
        self.frames += 1;
        if self.muscles.active(self.on_mv) {
            self.active.push(frame);
        }
        match (self.muscles.wish_to_open(self.on_mv), opens) {
            (true, false) => self.wish_since = self.wish_since.or(Some(frame)),
            // Answered; or given up before it was: then it waited for as long as it lasted.
            (true, true) | (false, _) => {
                let since = self.wish_since.take().or(opens.then_some(frame));
                self.slowest = self.slowest.max(since.map(|since| frame - since));
            }
        }
    }

    /// The verdict over the run; `active_first_s` is when a myosensor first became active.
    #[must_use]
    pub fn verdict(&self, active_first_s: Option<f64>) -> Wearer {
        Wearer {
            reflex_while_active: self.reflex_while_active,
            open_latency_ms: self.slowest.map(|frames| frames as f64 * 1e3 / f64::from(FRAME_HZ)),
            active_first_s,
            active_permille: (1_000 * self.active_slow_frames).checked_div(self.slow_frames).unwrap_or(0),
            reflex_ticks: self.reflex_ticks,
        }
    }
}

/// Frames in which something was so: from the first to before the last of each stretch.
#[derive(Clone, Debug, Default)]
struct Frames(Vec<Range<usize>>);

impl Frames {
    /// The next one, later than all before.
    fn push(&mut self, frame: usize) {
        match self.0.last_mut() {
            Some(stretch) if stretch.end == frame => stretch.end += 1,
            _ => self.0.push(frame..frame + 1),
        }
    }

    fn contains(&self, frame: usize) -> bool {
        let begun = self.0.partition_point(|stretch| stretch.start <= frame);
        begun.checked_sub(1).is_some_and(|last| self.0[last].contains(&frame))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_found_in_their_stretches() {
        let mut frames = Frames::default();
        [3, 4, 5, 9, 20].into_iter().for_each(|frame| frames.push(frame));
        assert_eq!(frames.0, [3..6, 9..10, 20..21]);
        let found: Vec<usize> = (0..25).filter(|&frame| frames.contains(frame)).collect();
        assert_eq!(found, [3, 4, 5, 9, 20]);
    }
}
