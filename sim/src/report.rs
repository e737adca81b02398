//! What a run tells: for programs as JSON with stable keys, for people as text.

pub mod added;
pub mod behaviours;
pub mod bound;
pub mod fate;
pub mod reflex;
pub mod replay;
pub mod scores;
pub mod text;
pub mod wearer;

use serde::Serialize;
use tenax_frames::words::in_words;
use tenax_hal_shim::channel::{FRAME_HZ, MYO_EXTENSOR, MYO_FLEXOR};
use tenax_hal_shim::motor::Duty;
use tenax_hal_shim::wire::{Event, EventKind};
use tenax_hal_shim::words::Fault;

use crate::board::Summary;
use crate::timeline::Timeline;

const CORE_HZ: f64 = 100e6;
/// Cycles an instruction takes on average, at least and at most: one for most, up to four for loads and branches, and three wait states
/// where the flash's cache misses. The emulated core counts instructions, and no real board has been measured.
pub const CYCLES_PER_INSTRUCTION: [f64; 2] = [1.0, 3.0];

/// A report. Its keys are stable: `tests/report.rs` lists them. Null where a thing did not happen.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub scene: String,
    pub board: &'static str,
    pub seed: u64,
    pub virtual_s: f64,
    pub wall_s: f64,
    pub overruns: u32,
    pub ticks: Ticks,
    pub load: Load,
    /// The deepest that the stack was, bytes. Null where it cannot be measured.
    pub stack_bytes: Option<u64>,
    pub slip: scores::Slip,
    pub bound: bound::Bound,
    pub controls: Vec<bound::Control>,
    pub grip: Grip,
    pub wearer: wearer::Wearer,
    pub margin: reflex::Margin,
    pub reflex: reflex::Reflex,
    /// Newtons that it added and took back: the same as below `reflex`.
    #[serde(flatten)]
    pub added: added::Sums,
    pub object: reflex::Object,
    pub behaviours: Vec<behaviours::Ran>,
    pub detectors: scores::Detectors,
    pub faults: Vec<FaultLine>,
    pub line: Line,
    pub replay: Option<replay::Replay>,
}

#[derive(Clone, Debug, Serialize)]
pub struct Ticks {
    pub count: u32,
    pub dropped: u32,
    pub instructions_mean: Option<f64>,
    pub instructions_max: Option<u64>,
    pub load_percent: Option<[f64; 2]>,
    pub core_load_percent: Option<[f64; 2]>,
}

/// What the core executes, in instructions. Null on a board whose instructions are not counted.
#[derive(Clone, Debug, Serialize)]
pub struct Load {
    pub tick_instructions_mean: Option<f64>,
    /// A period of 0.5 ms, mean: everything that the core executed, by the number of frames.
    pub period_instructions_mean: Option<f64>,
}

fn load_percent(instructions_per_s: f64) -> [f64; 2] {
    CYCLES_PER_INSTRUCTION.map(|cycles| instructions_per_s * cycles / CORE_HZ * 100.0)
}

#[derive(Clone, Debug, Default, Serialize)]
pub struct Grip {
    pub peak_force_n: Option<f64>,
    pub needed_force_n: Option<f64>,
    pub crushed_at_s: Option<f64>,
    pub dent_mm: Option<f64>,
    pub broken_at_s: Option<f64>,
}

#[derive(Clone, Debug, Serialize)]
pub struct FaultLine {
    /// When, s. Null for the reason of a restart.
    pub at_s: Option<f64>,
    pub what: String,
}

#[derive(Clone, Debug, Serialize)]
pub struct Line {
    pub bytes: usize,
    pub messages_missed: u64,
    pub telemetry_dropped: u32,
    pub bad_frames: u32,
}

#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    pub scene: &'a str,
    pub board: &'static str,
    pub seed: u64,
    pub run: &'a Summary,
    pub timeline: &'a Timeline,
    pub judge: &'a wearer::Judge,
    pub added: &'a added::Added,
    pub truth: Option<&'a fate::Fate>,
    pub bound: Option<&'a fate::Fate>,
}

impl Report {
    /// Makes a report; [`Report::replay`] is for whoever played a recording.
    pub fn new(subject: &Subject) -> Self {
        let (run, timeline) = (subject.run, subject.timeline);
        let (cost, frame_hz) = (run.tick_cost, f64::from(FRAME_HZ));
        let reflex = reflex::Reflex::of(subject.added, timeline, &run.events, subject.truth);
        Self {
            scene: subject.scene.to_owned(),
            board: subject.board,
            seed: subject.seed,
            virtual_s: run.virtual_s,
            wall_s: run.wall_s,
            overruns: run.counters.overruns,
            ticks: Ticks {
                count: run.counters.ticks,
                dropped: run.counters.frames_lost + run.counters.ticks_late,
                instructions_mean: cost.map(|cost| cost.instructions_mean),
                instructions_max: cost.map(|cost| cost.instructions_max),
                load_percent: cost.map(|cost| load_percent(cost.instructions_mean * frame_hz)),
                core_load_percent: cost.map(|cost| load_percent(cost.instructions_per_s)),
            },
            load: Load {
                tick_instructions_mean: cost.map(|cost| cost.instructions_mean),
                period_instructions_mean: cost.map(|cost| cost.instructions_per_s / frame_hz),
            },
            stack_bytes: run.stack_bytes,
            slip: scores::Slip::of(timeline, subject.truth),
            bound: bound::Bound::of(subject.truth, subject.bound),
            controls: Vec::new(),
            margin: reflex::Margin::of(subject.truth),
            added: reflex.sums,
            reflex,
            object: reflex::Object::of(subject.truth),
            behaviours: behaviours::of(&run.events, timeline),
            grip: subject.truth.map_or_else(Grip::default, |truth| Grip {
                peak_force_n: truth.peak_grip_n,
                needed_force_n: truth.needed_force_n,
                crushed_at_s: truth.crushed_at_s,
                dent_mm: truth.crushed_at_s.map(|_| truth.dent_mm),
                broken_at_s: truth.broken_at_s,
            }),
            wearer: wearer::Wearer {
                none: nobody_wears_it(run),
                vibration_steps: run.feedback.len(),
                vibration_s: vibrates_s(run),
                ..subject.judge.verdict(timeline.wearer(&run.events).first().copied(), myosensors_lost(run))
            },
            detectors: scores::Detectors::of(timeline, &run.events, subject.truth),
            faults: faults(run, timeline),
            line: Line {
                bytes: run.line_bytes,
                messages_missed: run.messages_missed,
                telemetry_dropped: run.counters.telemetry_dropped,
                bad_frames: run.counters.bad_frames,
            },
            replay: None,
        }
    }
}

fn nobody_wears_it(run: &Summary) -> bool {
    let told = run.events.iter().rev().find_map(|event| match event.kind {
        EventKind::NoWearer(none) => Some(none),
        _ => None,
    });
    told.unwrap_or(false)
}

fn vibrates_s(run: &Summary) -> f64 {
    let frames = |pair: &[(u32, Duty)]| match pair {
        [(from, duty), (to, _)] if *duty > Duty::default() => to - from,
        _ => 0,
    };
    f64::from(run.feedback.windows(2).map(frames).sum::<u32>()) / f64::from(FRAME_HZ)
}

fn myosensors_lost(run: &Summary) -> usize {
    let is_one = |channel: u8| (MYO_FLEXOR..=MYO_EXTENSOR).contains(&usize::from(channel));
    let lost = |event: &&Event| matches!(event.kind, EventKind::Fault(Fault::SensorLost { channel, .. }) if is_one(channel));
    run.events.iter().filter(lost).count()
}

fn faults(run: &Summary, timeline: &Timeline) -> Vec<FaultLine> {
    let starts = run.starts.iter().flatten().map(|fault| FaultLine { at_s: None, what: in_words(fault) });
    let events = run.events.iter().filter_map(|event| match event.kind {
        EventKind::Fault(fault) => {
            Some(FaultLine { at_s: Some(timeline.time_s(event.frame)), what: in_words(&fault) })
        }
        _ => None,
    });
    starts.chain(events).collect()
}
