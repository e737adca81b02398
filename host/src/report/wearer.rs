//! Whether the wearer came first, judged from the pins and not from what the fingertip says of itself.

use serde::Serialize;
use tenax_hal_shim::channel::{
    CHANNELS, FRAME_HZ, FRAMES_PER_SLOW_FRAME, MYO_EXTENSOR, MYO_SELECT, RANK_SWITCH_B, SCANS_PER_FRAME,
    mv_from_sample, select_of_place,
};
use tenax_hal_shim::frame::Scan;
use tenax_hal_shim::front_end::MYO_REST_MV;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::TickRecord;
use tenax_hal_shim::words::DriveSource;
use tenax_logic::config::Config;
use tenax_logic::gate::DOMINANCE_PERMILLE;

use crate::board::Run;
use crate::timeline::Timeline;

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
        let Some(muscle @ 0..=1) = select_of_place(place as u8).checked_sub(MYO_SELECT) else {
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

impl Wearer {
    /// Judges a run.
    #[must_use]
    pub fn of(run: &Run, timeline: Timeline) -> Self {
        let on_mv = i64::from(Config::default().gate.on_mv);
        let mut muscles = Muscles::default();
        let mut active = Vec::with_capacity(run.scans.len() / SCANS_PER_FRAME);
        let mut wish_since: Option<usize> = None;
        let mut slowest: Option<usize> = None;
        for (frame, scans) in run.scans.chunks_exact(SCANS_PER_FRAME).enumerate() {
            muscles.take(frame, scans);
            active.push(muscles.active(on_mv));
            let opens = run
                .drives
                .get(frame * SCANS_PER_FRAME + SCANS_PER_FRAME - 1)
                .is_some_and(|drive| drive.opens());
            match (muscles.wish_to_open(on_mv), opens) {
                (true, false) => wish_since = wish_since.or(Some(frame)),
                // Answered; or given up before it was: then it waited for as long as it lasted.
                (true, true) | (false, _) => {
                    let since = wish_since.take().or(opens.then_some(frame));
                    slowest = slowest.max(since.map(|since| frame - since));
                }
            }
        }
        let by_reflex =
            |tick: &TickRecord| tick.source == DriveSource::Reflex && tick.drive != MotorDrive::Coast;
        let reflex_frames = run.slows.iter().flat_map(|slow| {
            let first = slow.frame.saturating_sub(u32::from(FRAMES_PER_SLOW_FRAME) - 1);
            (first as usize..).zip(&slow.ticks).filter(|(_, tick)| by_reflex(tick)).map(|(frame, _)| frame)
        });
        let reflex_frames: Vec<usize> = reflex_frames.collect();
        let silent = |frame: &&usize| active.get(**frame).copied().unwrap_or(false);
        let slow_frames = run.slows.len() as u64;
        let active_slow_frames = run.slows.iter().filter(|slow| slow.wearer_active).count() as u64;
        Self {
            reflex_while_active: reflex_frames.iter().filter(silent).count() as u64,
            open_latency_ms: slowest.map(|frames| frames as f64 * 1e3 / f64::from(FRAME_HZ)),
            active_first_s: timeline.wearer().first().copied(),
            active_permille: (1_000 * active_slow_frames).checked_div(slow_frames).unwrap_or(0),
            reflex_ticks: reflex_frames.len() as u64,
        }
    }
}
