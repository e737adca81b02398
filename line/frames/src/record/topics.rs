//! Topics of a recording, their fields and values, for MCAP and CSV.

use std::borrow::Cow;

use tenax_hal_shim::channel::{CHANNELS, mv_from_sample};
use tenax_hal_shim::detector::Evidence;
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::wire::{Answer, Counters, Forces, Senses, Setting, Slow, TickRecord, Up};
use tenax_logic::setting::SettingId;

use crate::link::Clock;
use crate::protobuf::Fields;
use crate::protobuf::Value::{self, Flag, Number, Numbers, Text};
use crate::words::{line_words, names, seconds, words};

#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub topic: Cow<'static, str>,
    pub message: &'static str,
    /// The frame whose end is its time.
    pub frame: u32,
    pub fields: Fields,
}

/// Time without a message from which it is an event, s.
const SILENCE_S: f64 = 1.0;

/// The rows of a message that the clock hears, with those of a silence before it and of a start that nobody heard. None before the
/// first frame.
pub fn timed(clock: &mut Clock, message: &Up, came_ns: Option<u64>) -> Vec<Row> {
    let silent_s = clock.silence_s(came_ns);
    let is_missed = clock.hear(message, came_ns);
    let Some(last) = clock.last() else { return Vec::new() };
    let silence = (silent_s > SILENCE_S).then(|| event(&format!("nothing came for {silent_s:.1} s"), last));
    let start = is_missed.then(|| event("the board has started again: its first message was missed", last));
    silence.into_iter().chain(start).chain(rows(message, last)).collect()
}

fn event(words: &str, frame: u32) -> Row {
    row("/event", "Event", frame, [("text", Text(words.to_owned()))])
}

/// The rows of a message. `last` is the newest frame, for messages that name none.
pub fn rows(message: &Up, last: u32) -> Vec<Row> {
    let text = |frame| event(&words(message), frame);
    let settings = |all: &[Setting], frame| {
        [text(frame)].into_iter().chain(all.iter().map(|own| setting(own, frame))).collect()
    };
    match message {
        Up::Slow(slow) => slow_rows(slow),
        Up::Raw(raw) => raw.frames().iter().map(frame_row).collect(),
        Up::Senses(senses) => vec![sensors(senses)],
        Up::Counters(own) => vec![counters(own, last)],
        Up::About(about) => settings(&about.settings, last),
        Up::Answer { frame, answer, .. } => match answer {
            Answer::About(about) => settings(&about.settings, *frame),
            Answer::Setting(setting) => settings(&[*setting], *frame),
            Answer::Settings(all) => settings(all, *frame),
            _ => vec![text(*frame)],
        },
        Up::Event(event) => vec![text(event.frame)],
        Up::Saved { frame, .. } => vec![text(*frame)],
        Up::Taken { before, .. } => vec![text(before.wrapping_sub(1))],
        _ => vec![text(last)],
    }
}

fn row<const N: usize>(
    topic: impl Into<Cow<'static, str>>,
    message: &'static str,
    frame: u32,
    fields: [(&'static str, Value); N],
) -> Row {
    let fields = fields.map(|(name, value)| (name.into(), value)).into();
    Row { topic: topic.into(), message, frame, fields }
}

fn maybe(value: Option<impl Into<f64>>) -> Value {
    Number(value.map_or(f64::NAN, Into::into))
}

fn thousandth(value: impl Into<f64>) -> f64 {
    value.into() / 1e3
}

fn slow_rows(slow: &Slow) -> Vec<Row> {
    let first = slow.frame.wrapping_sub(slow.ticks.len() as u32 - 1);
    let ticks = (0..).zip(&slow.ticks).map(|(n, own)| tick(own, first.wrapping_add(n)));
    let detectors = slow.evidence.iter().map(|(id, own)| {
        let topic = format!("/detector/{}", id.name());
        row(topic, "Detector", slow.frame, evidence(own))
    });
    ticks.chain([state(slow)]).chain(detectors).collect()
}

fn state(slow: &Slow) -> Row {
    let newtons = |force: fn(&Forces) -> i32| maybe(slow.forces.as_ref().map(force).map(thousandth));
    let fields = [
        ("mode", Text(format!("{:?}", slow.mode))),
        ("fn_n", newtons(|forces| forces.fn_mn)),
        ("load_n", newtons(|forces| forces.load_mn)),
        ("fx_n", newtons(|forces| forces.fx_mn)),
        ("fy_n", newtons(|forces| forces.fy_mn)),
        ("ft_n", newtons(|forces| forces.ft_mn)),
        ("ratio", maybe(slow.forces.and_then(|forces| forces.ratio_permille).map(thousandth))),
        ("shear_rad", maybe(slow.shear_mrad.map(thousandth))),
        ("s2", Number(thousandth(slow.s2_permille))),
        ("margin_mn", maybe(slow.forces.and_then(|forces| forces.margin_mn(slow.s2_permille)))),
        ("flexor_mv", maybe(slow.flexor_mv)),
        ("extensor_mv", maybe(slow.extensor_mv)),
        ("wearer_active", Flag(slow.wearer_active)),
        ("line", Text(line_words(slow.line))),
    ];
    row("/state", "State", slow.frame, fields)
}

fn tick(tick: &TickRecord, frame: u32) -> Row {
    let fields = [
        ("vibration_mv", Number(mv_from_sample(tick.vibration).into())),
        ("o1", Number(f64::from(tick.outputs[0]) / 128.0)),
        ("o2", Number(f64::from(tick.outputs[1]) / 128.0)),
        ("drive", Number(thousandth(tick.drive.signed_permille()))),
        ("source", Text(format!("{:?}", tick.source))),
        ("said", Text(names(tick.said))),
        ("believed", Text(names(tick.believed))),
        ("acted", Text(names(tick.acted))),
    ];
    row("/tick", "Tick", frame, fields)
}

fn evidence(evidence: &Evidence) -> [(&'static str, Value); 7] {
    [
        ("slip", Flag(evidence.slip)),
        ("incipient", Flag(evidence.incipient)),
        ("confidence", Number(thousandth(evidence.confidence_permille))),
        ("direction", Text(format!("{:?}", evidence.direction))),
        ("health", Text(format!("{:?}", evidence.health))),
        ("raw", Number(evidence.raw.into())),
        ("decided_s", Number(seconds(evidence.decided_at))),
    ]
}

fn frame_row(frame: &Frame) -> Row {
    let fields = [
        ("valid", Flag(frame.valid)),
        ("films", Numbers(frame.pvdf.map(f64::from).to_vec())),
        ("switch_a", Number(frame.switch_a.into())),
        ("switch_b", Number(frame.switch_b.into())),
    ];
    row("/frame", "Frame", frame.sequence, fields)
}

fn sensors(senses: &Senses) -> Row {
    let mv = |sample: &u16| f64::from(mv_from_sample(*sample));
    let channels = CHANNELS.iter().zip(&senses.samples);
    let films = ("film_envelopes_mv".into(), Numbers(senses.films.iter().map(mv).collect()));
    let fields = channels
        .map(|(channel, sample)| (format!("{}_mv", channel.name).into(), Number(mv(sample))))
        .chain([films]);
    Row { topic: "/sensors".into(), message: "Sensors", frame: senses.frame, fields: fields.collect() }
}

fn counters(counters: &Counters, frame: u32) -> Row {
    let fields = [
        ("frames", counters.frames),
        ("frames_lost", counters.frames_lost),
        ("overruns", counters.overruns),
        ("ticks_late", counters.ticks_late),
        ("telemetry_dropped", counters.telemetry_dropped),
        ("bad_frames", counters.bad_frames),
        ("commands_skipped", counters.commands_skipped),
        ("control_us_max", counters.control_us_max),
        ("control_permille", counters.control_permille.into()),
    ];
    row("/counters", "Counters", frame, fields.map(|(name, count)| (name, Number(count.into()))))
}

fn setting(setting: &Setting, frame: u32) -> Row {
    let name = SettingId::from_number(setting.id)
        .map_or_else(|| format!("setting {}", setting.id), |id| id.row().name.to_owned());
    row("/setting", "Setting", frame, [("name", Text(name)), ("value", Number(setting.value.into()))])
}
