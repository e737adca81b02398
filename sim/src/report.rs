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
/// Cycles an instruction takes on average, at least and at most: a Cortex-M4 runs most instructions in one cycle, single
/// loads in two and taken branches in two to four, and the flash's three wait states are added wherever its prefetch and
/// cache miss. The emulated core counts instructions, not cycles, and no real board has been measured, so a load is a
/// bracket, and a wide one.
pub const CYCLES_PER_INSTRUCTION: [f64; 2] = [1.0, 3.0];

/// A report. Its keys are stable: `bench/tests/report.rs` lists them. Null where a thing did not happen.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The scene's name, or the recording's file.
    pub scene: String,
    /// "emulated" or "host".
    pub board: &'static str,
    /// Seed of every noise.
    pub seed: u64,
    pub virtual_s: f64,
    pub wall_s: f64,
    /// Times the converter or its DMA overran.
    pub overruns: u32,
    pub ticks: Ticks,
    /// What the core executes, in instructions.
    pub load: Load,
    /// The deepest that the stack was, bytes. Null where it cannot be measured.
    pub stack_bytes: Option<u64>,
    /// The first macro slip, and the object's whole fate.
    pub slip: scores::Slip,
    /// The least force that holds, planned ahead: the gripper's limit in this scene.
    pub bound: bound::Bound,
    /// The same scene with other grips (`run --controls`): no reflex, a constant grip of the same mean force, each detector alone,
    /// all but each.
    pub controls: Vec<bound::Control>,
    pub grip: Grip,
    pub wearer: wearer::Wearer,
    /// How far from slipping it was.
    pub margin: reflex::Margin,
    pub reflex: reflex::Reflex,
    /// Newtons that it added and took back: the same as below `reflex`.
    #[serde(flatten)]
    pub added: added::Sums,
    pub object: reflex::Object,
    /// What the hand did by itself because it was asked to.
    pub behaviours: Vec<behaviours::Ran>,
    pub detectors: scores::Detectors,
    /// Everything that went wrong, as it was reported.
    pub faults: Vec<FaultLine>,
    /// Other counts of the line and the board.
    pub line: Line,
    pub replay: Option<replay::Replay>,
}

#[derive(Clone, Debug, Serialize)]
pub struct Ticks {
    pub count: u32,
    /// Frames that had no tick in time: lost ones and late ones.
    pub dropped: u32,
    pub instructions_mean: Option<f64>,
    pub instructions_max: Option<u64>,
    /// Part of the core at 100 MHz that the ticks take, per cent, with [`CYCLES_PER_INSTRUCTION`] at its two ends.
    pub load_percent: Option<[f64; 2]>,
    /// The same for everything that the core does: ticks, interrupts, telemetry.
    pub core_load_percent: Option<[f64; 2]>,
}

impl Ticks {
    fn of(run: &Summary) -> Self {
        let cost = run.tick_cost;
        Self {
            count: run.counters.ticks,
            dropped: run.counters.frames_lost + run.counters.ticks_late,
            instructions_mean: cost.map(|cost| cost.instructions_mean),
            instructions_max: cost.map(|cost| cost.instructions_max),
            load_percent: cost.map(|cost| load_percent(cost.instructions_mean * f64::from(FRAME_HZ))),
            core_load_percent: cost.map(|cost| load_percent(cost.instructions_per_s)),
        }
    }
}

/// What the core executes, in instructions. Null on a board whose instructions are not counted.
#[derive(Clone, Debug, Serialize)]
pub struct Load {
    /// One tick of the logic, mean, what interrupted it included.
    pub tick_instructions_mean: Option<f64>,
    /// A period of 0.5 ms, mean: everything that the core executed, by the number of frames.
    pub period_instructions_mean: Option<f64>,
}

impl Load {
    fn of(run: &Summary) -> Self {
        let cost = run.tick_cost;
        Self {
            tick_instructions_mean: cost.map(|cost| cost.instructions_mean),
            period_instructions_mean: cost.map(|cost| cost.instructions_per_s / f64::from(FRAME_HZ)),
        }
    }
}

/// Per cent of the core at 100 MHz, as a bracket.
fn load_percent(instructions_per_s: f64) -> [f64; 2] {
    CYCLES_PER_INSTRUCTION.map(|cycles| instructions_per_s * cycles / CORE_HZ * 100.0)
}

/// Grip force, per finger.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Grip {
    pub peak_force_n: Option<f64>,
    /// The least that would have held the object at its heaviest, N.
    pub needed_force_n: Option<f64>,
    /// When it first crushed the object, s.
    pub crushed_at_s: Option<f64>,
    /// How deep, for good, mm.
    pub dent_mm: Option<f64>,
    /// When it broke the object, s.
    pub broken_at_s: Option<f64>,
}

/// A fault and when it was noticed.
#[derive(Clone, Debug, Serialize)]
pub struct FaultLine {
    /// When, s. Null for the reason of a restart.
    pub at_s: Option<f64>,
    /// What, in words.
    pub what: String,
}

/// What the serial line and the board counted.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    /// Bytes that came up.
    pub bytes: usize,
    /// Messages missing by their sequence numbers.
    pub messages_missed: u64,
    /// Messages that the board dropped so as not to delay control.
    pub telemetry_dropped: u32,
    /// Frames the board received that were no message.
    pub bad_frames: u32,
}

/// What a report is made from.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The scene's name, or the recording's file.
    pub scene: &'a str,
    /// "emulated" or "host".
    pub board: &'static str,
    /// Seed of every noise.
    pub seed: u64,
    pub run: &'a Summary,
    pub timeline: &'a Timeline,
    /// Who judged whether the wearer came first.
    pub judge: &'a wearer::Judge,
    /// Who measured what the reflex added.
    pub added: &'a added::Added,
    /// What really happened, where it is known.
    pub truth: Option<&'a fate::Fate>,
    /// The bound's run, where there is one.
    pub bound: Option<&'a fate::Fate>,
}

impl Report {
    /// Makes a report; [`Report::replay`] is for whoever played a recording.
    pub fn new(subject: &Subject) -> Self {
        let (run, timeline) = (subject.run, subject.timeline);
        let reflex = reflex::Reflex::of(subject.added, timeline, &run.events, subject.truth);
        Self {
            scene: subject.scene.to_owned(),
            board: subject.board,
            seed: subject.seed,
            virtual_s: run.virtual_s,
            wall_s: run.wall_s,
            overruns: run.counters.overruns,
            ticks: Ticks::of(run),
            load: Load::of(run),
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

/// Whether the board last said that nobody wears the hand.
fn nobody_wears_it(run: &Summary) -> bool {
    let told = run.events.iter().rev().find_map(|event| match event.kind {
        EventKind::NoWearer(none) => Some(none),
        _ => None,
    });
    told.unwrap_or(false)
}

/// For how long the vibration motor was driven, s. One that a run ends on is not counted to the end.
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
