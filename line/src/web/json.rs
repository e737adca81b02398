//! What the page is told.

use serde_json::{Value, json};
use tenax_hal_shim::channel::{CHANNELS, Channel, mv_from_sample};
use tenax_hal_shim::detector::DetectorId;
use tenax_logic::setting::SettingId;

use super::Seen;
use super::wizard::Wizard;
use crate::guide::selftest::Verdict;
use crate::monitor::view::{Point, View};
use crate::wiring::input;
use tenax_frames::settings::Trace;

/// Lines of the log in one event at most.
const LINES_MAX: usize = 50;

/// What a page has been told already.
#[derive(Clone, Copy, Debug)]
pub struct After {
    /// Points up to this instant, s.
    pub points_s: f64,
    /// What was true up to this one.
    pub truth_s: f64,
    /// Lines of the log.
    pub lines: u64,
    /// The self-test, by its number, and lines of it.
    pub selftest: (u64, usize),
}

impl After {
    pub const NOTHING: Self = Self { points_s: f64::MIN, truth_s: f64::MIN, lines: 0, selftest: (0, 0) };

    /// All that there is. A board or a scene that started anew counts from 0 again.
    pub fn all(Seen { view, wizard }: &Seen) -> Self {
        Self {
            points_s: view.t_s(),
            truth_s: view.truth.back().map_or(f64::MIN, |truth| truth.t_s),
            lines: view.said(),
            selftest: (wizard.number(), wizard.lines()),
        }
    }
}

/// What is new, and the state.
pub fn event(Seen { view, wizard }: &Seen, place: &str, after: &After) -> Value {
    let points: Vec<Value> = view
        .history
        .iter()
        .filter(|point| point.t_s > after.points_s)
        .map(|point| {
            let Point { t_s, vibration_mv, ratio, s2, load_n, flexor_mv, extensor_mv } = point;
            json!([t_s, vibration_mv, ratio, s2, load_n, flexor_mv, extensor_mv])
        })
        .collect();
    let new = usize::try_from(view.said() - after.lines.min(view.said())).unwrap_or(LINES_MAX).min(LINES_MAX);
    let log: Vec<&str> =
        view.log.iter().skip(view.log.len().saturating_sub(new)).map(|line| line.trim_start()).collect();
    let slow = view.slow.as_ref();
    let counters = view.counters.unwrap_or_default();
    let detectors: Vec<Value> = DetectorId::ALL
        .into_iter()
        // Nothing is injected but by a test.
        .filter(|&id| id != DetectorId::Injected)
        .map(|id| {
            let fate = &view.fates[id as usize];
            let evidence = fate.evidence;
            json!({
                "name": id.name(),
                "slip": evidence.is_some_and(|evidence| evidence.slip),
                "incipient": evidence.is_some_and(|evidence| evidence.incipient),
                "confidence": evidence.map(|evidence| f64::from(evidence.confidence_permille) / 10.0),
                "health": evidence.map(|evidence| format!("{:?}", evidence.health)),
                "said": fate.said, "believed": fate.believed, "acted": fate.acted,
            })
        })
        .collect();
    let truths: Vec<Value> = view
        .truth
        .iter()
        .filter(|truth| truth.t_s > after.truth_s)
        .map(|truth| json!([truth.t_s, truth.slide_mm_s, truth.needed_n, truth.grip_n]))
        .collect();
    let sensors = view.senses.as_ref().map(|senses| {
        let reading = |(channel, &sample): (&Channel, &u16)| json!([channel.name, mv_from_sample(sample)]);
        CHANNELS.iter().zip(&senses.samples).map(reading).collect::<Vec<Value>>()
    });
    json!({
        "sensors": sensors,
        "truth": view.truth.back().map(|truth| json!({ "now": truth, "contact": truth.contact() })),
        "truths": truths,
        "place": place,
        "gone": view.gone,
        "other_version": view.other_version,
        "t_s": view.t_s(),
        "frame": slow.map(|slow| slow.frame),
        "mode": slow.map(|slow| format!("{:?}", slow.mode)),
        "line": slow.map(|slow| format!("{:?}", slow.line)),
        "flexor_mv": slow.and_then(|slow| slow.flexor_mv),
        "extensor_mv": slow.and_then(|slow| slow.extensor_mv),
        "wearer_active": slow.is_some_and(|slow| slow.wearer_active),
        "s1_mv": view.setting(SettingId::S1),
        "emg_on_mv": view.setting(SettingId::EmgOn),
        "playing": view.playing,
        "rates": view.rates(),
        "missed": view.counts.missed,
        "bad_frames": view.counts.bad_frames,
        "frames_lost": counters.frames_lost,
        "dropped": counters.telemetry_dropped,
        "late": counters.ticks_late,
        "control_percent": f64::from(counters.control_permille) / 10.0,
        "control_us_max": counters.control_us_max,
        "faults": view.faults,
        "detectors": detectors,
        "points": points,
        "log": log,
        "bench": view.bench.as_ref().map(|bench| &bench.keys),
        "selftest": selftest(wizard, after.selftest),
    })
}

/// How the self-test stands; its lines and verdicts only where there are new ones.
fn selftest(wizard: &Wizard, (number, lines): (u64, usize)) -> Value {
    let Some(session) = wizard.session() else { return Value::Null };
    let (test, said) = (session.test(), session.said());
    let known = if number == wizard.number() { lines.min(said.len()) } else { 0 };
    let is_new = known < said.len() || number != wizard.number();
    let results = || -> Vec<Value> {
        let row = |&channel: &usize| {
            let verdict = test.verdict(channel);
            let state = verdict.map(|verdict| matches!(verdict, Verdict::Pass(_)));
            let words = verdict.map(|verdict| test.words(channel, verdict));
            json!([CHANNELS[channel].name, input(channel), state, words])
        };
        test.channels().iter().map(row).collect()
    };
    let level = test
        .level()
        .map(|level| json!({ "mv": level.mv, "moved_mv": level.moved_mv, "needed_mv": level.needed_mv }));
    json!({
        "number": wizard.number(),
        "prompt": test.prompt(),
        "over": test.is_over(),
        "passes": test.passes(),
        "failed": wizard.failed(),
        "level": level,
        "lines": &said[known..],
        "results": is_new.then(results),
    })
}

/// Every setting with what a person needs to know of it.
pub fn settings(view: &View, control: bool) -> Value {
    let rows: Vec<Value> = SettingId::ALL
        .into_iter()
        .map(|id| {
            let row = id.row();
            let (min, max) = row.range().into_inner();
            json!({
                "name": row.name, "unit": row.unit, "min": min, "max": max, "default": row.default,
                "meaning": row.meaning, "value": view.setting(id), "trace": Trace::of(id),
            })
        })
        .collect();
    json!({ "control": control, "settings": rows })
}
