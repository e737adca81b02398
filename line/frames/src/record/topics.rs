//! What of a board's messages goes where in a recording: topics, their fields, and the values, for MCAP and CSV alike.

use tenax_hal_shim::channel::{CHANNELS, mv_from_sample};
use tenax_hal_shim::detector::{DetectorId, Evidence};
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Answer, Counters, Forces, Setting, Slow, TickRecord, Up};
use tenax_logic::setting::SettingId;

use crate::link::captured;
use crate::protobuf::{Kind, Value};
use crate::words::{Words, names, seconds};

/// Where values go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Topic {
    /// The line's bytes: all there is to know.
    Line,
    /// Mode, forces, muscles, 80 times a second.
    State,
    /// What every tick decided, 2000 times a second.
    Tick,
    /// What a detector concluded, 80 times a second.
    Detector(DetectorId),
    /// Frames as they were sampled, 2000 times a second, if they were asked for.
    Frame,
    /// Every sensor's reading, 80 times a second, if they were asked for.
    Sensors,
    /// What happened, in words.
    Event,
    Counters,
    /// Settings whose value was said.
    Setting,
}

impl Topic {
    pub fn all() -> Vec<Self> {
        let detectors = DetectorId::ALL.map(Self::Detector);
        let rest =
            [Self::State, Self::Tick, Self::Frame, Self::Sensors, Self::Event, Self::Counters, Self::Setting];
        [Self::Line].into_iter().chain(rest).chain(detectors).collect()
    }

    /// Those of a compact recording: the line, from which all others can be made again, and what a person draws first.
    pub fn compact() -> Vec<Self> {
        vec![Self::Line, Self::State, Self::Event, Self::Counters, Self::Setting]
    }

    /// What it is called in the file.
    pub fn name(self) -> String {
        match self {
            Self::Line => captured::TOPIC.to_owned(),
            Self::State => "/state".to_owned(),
            Self::Tick => "/tick".to_owned(),
            Self::Detector(id) => format!("/detector/{}", id.name()),
            Self::Frame => "/frame".to_owned(),
            Self::Sensors => "/sensors".to_owned(),
            Self::Event => "/event".to_owned(),
            Self::Counters => "/counters".to_owned(),
            Self::Setting => "/setting".to_owned(),
        }
    }

    /// What its messages are called.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Line => "Line",
            Self::State => "State",
            Self::Tick => "Tick",
            Self::Detector(_) => "Detector",
            Self::Frame => "Frame",
            Self::Sensors => "Sensors",
            Self::Event => "Event",
            Self::Counters => "Counters",
            Self::Setting => "Setting",
        }
    }

    pub fn fields(self) -> Vec<(String, Kind)> {
        match self {
            Self::Line => vec![("data".to_owned(), Kind::Bytes)],
            Self::State => fields(&STATE),
            Self::Tick => fields(&TICK),
            Self::Detector(_) => fields(&DETECTOR),
            Self::Frame => fields(&FRAME),
            Self::Sensors => {
                let channels = CHANNELS.iter().map(|channel| (identifier(channel.name, "mv"), Kind::Number));
                channels.chain([("film_envelopes_mv".to_owned(), Kind::Numbers)]).collect()
            }
            Self::Event => fields(&EVENT),
            Self::Counters => fields(&COUNTERS),
            Self::Setting => fields(&SETTING),
        }
    }
}

/// How a field is read from what the board said.
enum Read<T> {
    Number(fn(&T) -> f64),
    /// NaN: there was none.
    Maybe(fn(&T) -> Option<f64>),
    Numbers(fn(&T) -> Vec<f64>),
    Flag(fn(&T) -> bool),
    Text(fn(&T) -> String),
}

/// A field: its name, and how it is read.
type Field<T> = (&'static str, Read<T>);

use Read::{Flag, Maybe, Number, Numbers, Text};

const STATE: [Field<Slow>; 13] = [
    ("mode", Text(|slow| format!("{:?}", slow.mode))),
    ("fn_n", Maybe(|slow| newtons(slow, |forces| forces.fn_mn))),
    ("load_n", Maybe(|slow| newtons(slow, |forces| forces.load_mn))),
    ("fx_n", Maybe(|slow| newtons(slow, |forces| forces.fx_mn))),
    ("fy_n", Maybe(|slow| newtons(slow, |forces| forces.fy_mn))),
    ("ft_n", Maybe(|slow| newtons(slow, |forces| forces.ft_mn))),
    ("ratio", Maybe(|slow| Some(f64::from(slow.forces?.ratio_permille?) / 1e3))),
    ("s2", Number(|slow| f64::from(slow.s2_permille) / 1e3)),
    ("margin_mn", Maybe(|slow| Some(slow.forces?.margin_mn(slow.s2_permille)?.into()))),
    ("flexor_mv", Maybe(|slow| slow.flexor_mv.map(f64::from))),
    ("extensor_mv", Maybe(|slow| slow.extensor_mv.map(f64::from))),
    ("wearer_active", Flag(|slow| slow.wearer_active)),
    ("line", Text(|slow| format!("{:?}", slow.line))),
];

const TICK: [Field<TickRecord>; 8] = [
    ("vibration_mv", Number(|tick| mv_from_sample(tick.vibration).into())),
    ("o1", Number(|tick| f64::from(tick.outputs[0]) / 128.0)),
    ("o2", Number(|tick| f64::from(tick.outputs[1]) / 128.0)),
    ("drive", Number(|tick| duty(tick.drive))),
    ("source", Text(|tick| format!("{:?}", tick.source))),
    ("said", Text(|tick| names(tick.said))),
    ("believed", Text(|tick| names(tick.believed))),
    ("acted", Text(|tick| names(tick.acted))),
];

const DETECTOR: [Field<Evidence>; 7] = [
    ("slip", Flag(|evidence| evidence.slip)),
    ("incipient", Flag(|evidence| evidence.incipient)),
    ("confidence", Number(|evidence| f64::from(evidence.confidence_permille) / 1e3)),
    ("direction", Text(|evidence| format!("{:?}", evidence.direction))),
    ("health", Text(|evidence| format!("{:?}", evidence.health))),
    ("raw", Number(|evidence| evidence.raw.into())),
    ("decided_s", Number(|evidence| seconds(evidence.decided_at))),
];

const FRAME: [Field<Frame>; 4] = [
    ("valid", Flag(|frame| frame.valid)),
    ("films", Numbers(|frame| frame.pvdf.map(f64::from).to_vec())),
    ("switch_a", Number(|frame| frame.switch_a.into())),
    ("switch_b", Number(|frame| frame.switch_b.into())),
];

const EVENT: [Field<Up>; 1] = [("text", Text(|message| Words(message).to_string()))];

const COUNTERS: [Field<Counters>; 9] = [
    ("frames", Number(|counters| counters.frames.into())),
    ("frames_lost", Number(|counters| counters.frames_lost.into())),
    ("overruns", Number(|counters| counters.overruns.into())),
    ("ticks_late", Number(|counters| counters.ticks_late.into())),
    ("telemetry_dropped", Number(|counters| counters.telemetry_dropped.into())),
    ("bad_frames", Number(|counters| counters.bad_frames.into())),
    ("commands_skipped", Number(|counters| counters.commands_skipped.into())),
    ("control_us_max", Number(|counters| counters.control_us_max.into())),
    ("control_permille", Number(|counters| counters.control_permille.into())),
];

const SETTING: [Field<Setting>; 2] =
    [("name", Text(|setting| setting_name(setting.id))), ("value", Number(|setting| setting.value.into()))];

fn fields<T>(all: &[Field<T>]) -> Vec<(String, Kind)> {
    let kind = |read: &Read<T>| match read {
        Number(_) | Maybe(_) => Kind::Number,
        Numbers(_) => Kind::Numbers,
        Flag(_) => Kind::Flag,
        Text(_) => Kind::Text,
    };
    all.iter().map(|(name, read)| ((*name).to_owned(), kind(read))).collect()
}

fn values<T>(all: &[Field<T>], of: &T) -> Vec<Value> {
    let value = |(_, read): &Field<T>| match read {
        Number(read) => Value::Number(read(of)),
        Maybe(read) => Value::Number(read(of).unwrap_or(f64::NAN)),
        Numbers(read) => Value::Numbers(read(of)),
        Flag(read) => Value::Flag(read(of)),
        Text(read) => Value::Text(read(of)),
    };
    all.iter().map(value).collect()
}

fn newtons(slow: &Slow, force: fn(&Forces) -> i32) -> Option<f64> {
    slow.forces.as_ref().map(|forces| f64::from(force(forces)) / 1e3)
}

/// From -1, opening, to 1, closing.
fn duty(drive: MotorDrive) -> f64 {
    match drive {
        MotorDrive::Coast => 0.0,
        MotorDrive::Close(duty) => f64::from(duty.as_per_mille()) / 1e3,
        MotorDrive::Open(duty) => -f64::from(duty.as_per_mille()) / 1e3,
    }
}

fn setting_name(id: u8) -> String {
    SettingId::from_number(id).map_or_else(|| format!("setting {id}"), |id| id.row().name.to_owned())
}

/// A channel's name as protobuf takes it.
fn identifier(name: &str, unit: &str) -> String {
    let name: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect();
    format!("{name}_{unit}")
}

/// What a message says, each with the frame that it is of. `last` is the frame that was heard of last, for messages that
/// name none.
pub fn rows(message: &Up, last: u32) -> Vec<(Topic, u32, Vec<Value>)> {
    let text = |frame: u32| (Topic::Event, frame, values(&EVENT, message));
    let settings = |all: &[Setting], frame: u32| {
        let row = |setting| (Topic::Setting, frame, values(&SETTING, setting));
        [text(frame)].into_iter().chain(all.iter().map(row)).collect()
    };
    match message {
        Up::Slow(slow) => slow_rows(slow),
        Up::Raw(raw) => {
            raw.frames().iter().map(|frame| (Topic::Frame, frame.sequence, values(&FRAME, frame))).collect()
        }
        Up::Senses(senses) => {
            let mv = |sample: &u16| f64::from(mv_from_sample(*sample));
            let films = Value::Numbers(senses.films.iter().map(mv).collect());
            let values =
                senses.samples.iter().map(|sample| Value::Number(mv(sample))).chain([films]).collect();
            vec![(Topic::Sensors, senses.frame, values)]
        }
        Up::Counters(counters) => vec![(Topic::Counters, last, values(&COUNTERS, counters))],
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

fn slow_rows(slow: &Slow) -> Vec<(Topic, u32, Vec<Value>)> {
    let first = slow.frame.wrapping_sub(slow.ticks.len() as u32 - 1);
    let ticks =
        (0..).zip(&slow.ticks).map(|(n, tick)| (Topic::Tick, first.wrapping_add(n), values(&TICK, tick)));
    let evidence =
        slow.evidence.iter().map(|(id, own)| (Topic::Detector(*id), slow.frame, values(&DETECTOR, own)));
    ticks.chain([(Topic::State, slow.frame, values(&STATE, slow))]).chain(evidence).collect()
}
