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
use tenax_hal_shim::wire::Slow;
use tenax_hal_shim::words::DriveSource;
use tenax_logic::emg::decide::Decide;
use tenax_logic::emg::level::FLOOR_UV;
use tenax_logic::emg::model::EmgModel;

use crate::board::Recorder;
use crate::timeline::ticks;

const ON_MV: i64 = 160;

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Wearer {
    pub none: bool,
    pub reflex_while_active: u64,
    /// The longest time from a reading a fifth above the calibrated opening to the motor opening, ms. Null where nobody wished to open, or
    /// nobody is calibrated.
    pub open_latency_ms: Option<f64>,
    pub active_first_s: Option<f64>,
    pub active_permille: u64,
    pub reflex_ticks: u64,
    pub closing_s: f64,
    pub opening_s: f64,
    pub longest_open_ms: f64,
    pub longest_close_ms: f64,
    pub faults: usize,
    /// How often the vibration motor changed its drive, and for how long it ran, s.
    pub vibration_steps: usize,
    pub vibration_s: f64,
}

/// What the two muscles' pins last read, mV above rest.
#[derive(Clone, Copy, Debug, Default)]
struct Muscles([i64; 2]);

impl Muscles {
    fn take(&mut self, frame: usize, scans: &[Scan]) {
        let place = frame % usize::from(FRAMES_PER_SLOW_FRAME);
        let channel = SCHEDULE[place].switch_b.map(usize::from);
        let Some(muscle @ 0..=1) = channel.and_then(|channel| channel.checked_sub(MYO_FLEXOR)) else {
            return;
        };
        let sample: u16 = scans.iter().map(|scan| scan[RANK_SWITCH_B]).sum();
        self.0[muscle] = i64::from(mv_from_sample(sample)) - i64::from(MYO_REST_MV);
    }

    fn active(self, on_mv: [i64; 2], hears: impl Fn(usize) -> bool) -> bool {
        (0..2).any(|n| self.0[n] >= on_mv[n] && hears(n))
    }

    fn is_shorted(self) -> bool {
        let high_mv = i64::from(CHANNELS[MYO_EXTENSOR].high_mv) - i64::from(MYO_REST_MV);
        self.0.iter().any(|&mv| mv > high_mv)
    }
}

/// The envelope of a level, mV.
fn mv_of(level: i32) -> f64 {
    ((f64::from(level) / 1_024.0).exp2() - f64::from(FLOOR_UV)) / 1e3
}

#[derive(Clone, Copy, Debug)]
struct Opening {
    site: usize,
    from_mv: f64,
    ratio: f64,
}

impl Opening {
    fn of(model: &EmgModel) -> Self {
        let (opens, closes) = (model.opening_site(), model.closing_site());
        let ratio = |point: [i32; 2]| mv_of(point[opens]) / mv_of(point[closes]).max(1.0);
        let (open, close) = (ratio(model.open()).log2(), ratio(model.close()).log2());
        Self {
            site: opens,
            from_mv: 1.2 * mv_of(model.open()[opens]),
            ratio: (close + 0.62 * (open - close)).exp2(),
        }
    }

    fn is_wished(&self, muscles: Muscles) -> bool {
        let Muscles(mv) = muscles;
        let (own, other) = (mv[self.site] as f64, mv[1 - self.site].max(1) as f64);
        !muscles.is_shorted() && own >= self.from_mv && own >= self.ratio * other
    }
}

#[derive(Clone, Debug, Default)]
pub struct Judge {
    on_mv: [i64; 2],
    opening: Option<Opening>,
    muscles: Muscles,
    /// When which electrode is known to be off, s: what it gives is no activity.
    pub deaf: Vec<(usize, Range<f64>)>,
    scans: Vec<Scan>,
    /// Whether a muscle was active at the pins, by frame.
    active: Vec<bool>,
    wish_since: Option<usize>,
    opened: bool,
    slowest: Option<usize>,
    reflex_ticks: u64,
    reflex_while_active: u64,
    slow_frames: u64,
    active_slow_frames: u64,
    closed: Stretch,
    opened_by_muscle: Stretch,
}

#[derive(Clone, Copy, Debug, Default)]
struct Stretch {
    now: u64,
    longest: u64,
    all: u64,
}

impl Stretch {
    fn push(&mut self, is: bool) {
        self.now = if is { self.now + 1 } else { 0 };
        self.longest = self.longest.max(self.now);
        self.all += u64::from(is);
    }
}

impl Judge {
    pub fn new(calibrated: Option<&EmgModel>) -> Self {
        // Whoever contracts with less than any muscle does is active all the same; a wearer whose rest is strong, later.
        let on_mv = calibrated.map_or([ON_MV; 2], |model| {
            let decide = Decide::new(Some(model));
            [0, 1].map(|n| ON_MV.max(i64::from(decide.active_uv(n)[0]) / 1_000 + 2))
        });
        Self { on_mv, opening: calibrated.map(Opening::of), ..Self::default() }
    }

    fn frame(&mut self, opens: bool) {
        let frame = self.active.len();
        let t_s = frame as f64 / f64::from(FRAME_HZ);
        let hears = |n: usize| !self.deaf.iter().any(|(deaf, s)| *deaf == n && s.contains(&t_s));
        self.active.push(self.muscles.active(self.on_mv, hears));
        let wishes = self.opening.is_some_and(|opening| opening.is_wished(self.muscles));
        match (wishes, opens) {
            // A wish that has taken effect may wait for its proof, and one of a lost sensor rests.
            (true, false) if self.opened => {}
            (true, false) => self.wish_since = self.wish_since.or(Some(frame)),
            // Answered; or given up before it was: then it waited for as long as it lasted.
            (true, true) | (false, _) => {
                let since = self.wish_since.take().or((wishes && opens).then_some(frame));
                self.slowest = self.slowest.max(since.map(|since| frame - since));
                self.opened = wishes;
            }
        }
    }

    /// The verdict over the run; `active_first_s` is when a myosensor first became active, `faults` how often one was lost.
    pub fn verdict(&self, active_first_s: Option<f64>, faults: usize) -> Wearer {
        let seconds = |ticks: u64| ticks as f64 / f64::from(FRAME_HZ);
        Wearer {
            reflex_while_active: self.reflex_while_active,
            open_latency_ms: self.slowest.map(|frames| frames as f64 * 1e3 / f64::from(FRAME_HZ)),
            active_first_s,
            active_permille: (1_000 * self.active_slow_frames).checked_div(self.slow_frames).unwrap_or(0),
            reflex_ticks: self.reflex_ticks,
            closing_s: seconds(self.closed.all),
            opening_s: seconds(self.opened_by_muscle.all),
            longest_open_ms: 1e3 * seconds(self.opened_by_muscle.longest),
            longest_close_ms: 1e3 * seconds(self.closed.longest),
            faults,
            ..Wearer::default()
        }
    }
}

impl Recorder for Judge {
    fn scan(&mut self, codes: &Scan, drive: MotorDrive) {
        self.scans.push(*codes);
        if self.scans.len() == SCANS_PER_FRAME {
            self.muscles.take(self.active.len(), &self.scans);
            self.scans.clear();
            self.frame(drive.opens());
        }
    }

    fn slow(&mut self, slow: &Slow) {
        self.slow_frames += 1;
        self.active_slow_frames += u64::from(slow.wearer_active);
        for (frame, tick) in ticks(slow) {
            if tick.source == DriveSource::Reflex && tick.drive != MotorDrive::Coast {
                self.reflex_ticks += 1;
                self.reflex_while_active += u64::from(self.active.get(frame as usize) == Some(&true));
            }
            let wearers = tick.source == DriveSource::Wearer;
            self.closed.push(wearers && tick.drive.closes());
            self.opened_by_muscle.push(wearers && tick.drive.opens());
        }
    }
}
