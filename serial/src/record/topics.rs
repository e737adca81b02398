//! What of a board's messages goes where in a recording: topics, their fields, and the values, for MCAP and CSV alike.

use tenax_hal_shim::channel::{CHANNELS, FRAME_HZ, mv_from_sample};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{About, Answer, Counters, Setting, Slow, TickRecord, Up};
use tenax_logic::setting::SettingId;

use crate::link::captured;
use crate::protobuf::{Kind, Value};
use crate::words::{Words, names};

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

    /// The fields of its messages.
    pub fn fields(self) -> Vec<(String, Kind)> {
        use Kind::{Bytes, Flag, Number, Numbers, Text};
        let named =
            |fields: &[(&str, Kind)]| fields.iter().map(|(name, kind)| ((*name).to_owned(), *kind)).collect();
        match self {
            Self::Line => named(&[("data", Bytes)]),
            Self::State => named(&[
                ("mode", Text),
                ("fn_n", Number),
                ("load_n", Number),
                ("fx_n", Number),
                ("fy_n", Number),
                ("ft_n", Number),
                ("ratio", Number),
                ("s2", Number),
                ("margin_mn", Number),
                ("flexor_mv", Number),
                ("extensor_mv", Number),
                ("wearer_active", Flag),
                ("line", Text),
            ]),
            Self::Tick => named(&[
                ("vibration_mv", Number),
                ("o1", Number),
                ("o2", Number),
                ("drive", Number),
                ("source", Text),
                ("said", Text),
                ("believed", Text),
                ("acted", Text),
            ]),
            Self::Detector(_) => named(&[
                ("slip", Flag),
                ("incipient", Flag),
                ("confidence", Number),
                ("direction", Text),
                ("health", Text),
                ("raw", Number),
                ("decided_s", Number),
            ]),
            Self::Frame => {
                named(&[("valid", Flag), ("films", Numbers), ("switch_a", Number), ("switch_b", Number)])
            }
            Self::Sensors => {
                let channels = CHANNELS.iter().map(|channel| (identifier(channel.name, "mv"), Number));
                channels.chain([("film_envelopes_mv".to_owned(), Numbers)]).collect()
            }
            Self::Event => named(&[("text", Text)]),
            Self::Counters => named(&[
                ("frames", Number),
                ("frames_lost", Number),
                ("overruns", Number),
                ("ticks_late", Number),
                ("telemetry_dropped", Number),
                ("bad_frames", Number),
                ("commands_skipped", Number),
                ("control_us_max", Number),
                ("control_permille", Number),
            ]),
            Self::Setting => named(&[("name", Text), ("value", Number)]),
        }
    }
}

/// A channel's name as protobuf takes it.
fn identifier(name: &str, unit: &str) -> String {
    let name: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect();
    format!("{name}_{unit}")
}

/// When a frame ended, s of the board's time.
pub fn seconds(frame: u32) -> f64 {
    (f64::from(frame) + 1.0) / f64::from(FRAME_HZ)
}

/// What a message says, each with the frame that it is of. `last` is the frame that was heard of last, for messages that
/// name none.
pub fn rows(message: &Up, last: u32) -> Vec<(Topic, u32, Vec<Value>)> {
    match message {
        Up::Slow(slow) => slow_rows(slow),
        Up::Raw(raw) => raw
            .frames()
            .iter()
            .map(|frame| {
                let films = frame.pvdf.iter().map(|&sample| f64::from(sample)).collect();
                let switches = [frame.switch_a, frame.switch_b].map(|sample| Value::Number(sample.into()));
                let values = [Value::Flag(frame.valid), Value::Numbers(films)].into_iter().chain(switches);
                (Topic::Frame, frame.sequence, values.collect())
            })
            .collect(),
        Up::Senses(senses) => {
            let mv = |sample: &u16| f64::from(mv_from_sample(*sample));
            let films = Value::Numbers(senses.films.iter().map(mv).collect());
            let values =
                senses.samples.iter().map(|sample| Value::Number(mv(sample))).chain([films]).collect();
            vec![(Topic::Sensors, senses.frame, values)]
        }
        Up::Counters(counters) => vec![(Topic::Counters, last, counter_values(counters))],
        Up::About(about) => text_and_settings(message, about, last),
        Up::Answer { frame, answer, .. } => match answer {
            Answer::About(about) => text_and_settings(message, about, *frame),
            Answer::Setting(setting) => vec![text(message, *frame), setting_row(setting, *frame)],
            Answer::Settings(all) => {
                let settings = all.iter().map(|setting| setting_row(setting, *frame));
                [text(message, *frame)].into_iter().chain(settings).collect()
            }
            _ => vec![text(message, *frame)],
        },
        Up::Event(event) => vec![text(message, event.frame)],
        Up::Saved { frame, .. } => vec![text(message, *frame)],
        Up::Taken { before, .. } => vec![text(message, before.wrapping_sub(1))],
        _ => vec![text(message, last)],
    }
}

fn text(message: &Up, frame: u32) -> (Topic, u32, Vec<Value>) {
    (Topic::Event, frame, vec![Value::Text(Words(message).to_string())])
}

fn text_and_settings(message: &Up, about: &About, frame: u32) -> Vec<(Topic, u32, Vec<Value>)> {
    let settings = about.settings.iter().map(|setting| setting_row(setting, frame));
    [text(message, frame)].into_iter().chain(settings).collect()
}

fn setting_row(setting: &Setting, frame: u32) -> (Topic, u32, Vec<Value>) {
    let name = SettingId::from_number(setting.id)
        .map_or_else(|| format!("setting {}", setting.id), |id| id.row().name.to_owned());
    (Topic::Setting, frame, vec![Value::Text(name), Value::Number(setting.value.into())])
}

fn slow_rows(slow: &Slow) -> Vec<(Topic, u32, Vec<Value>)> {
    let number = |value: Option<f64>| Value::Number(value.unwrap_or(f64::NAN));
    let force = |value: fn(&tenax_hal_shim::wire::Forces) -> i32| {
        number(slow.forces.as_ref().map(|forces| f64::from(value(forces)) / 1e3))
    };
    let ratio = slow.forces.and_then(|forces| forces.ratio_permille).map(|ratio| f64::from(ratio) / 1e3);
    let state = vec![
        Value::Text(format!("{:?}", slow.mode)),
        force(|forces| forces.fn_mn),
        force(|forces| forces.load_mn),
        force(|forces| forces.fx_mn),
        force(|forces| forces.fy_mn),
        force(|forces| forces.ft_mn),
        number(ratio),
        number(Some(f64::from(slow.s2_permille) / 1e3)),
        number(slow.forces.and_then(|forces| forces.margin_mn(slow.s2_permille)).map(f64::from)),
        number(slow.flexor_mv.map(f64::from)),
        number(slow.extensor_mv.map(f64::from)),
        Value::Flag(slow.wearer_active),
        Value::Text(format!("{:?}", slow.line)),
    ];
    let first = slow.frame.wrapping_sub(slow.ticks.len() as u32 - 1);
    let ticks =
        slow.ticks.iter().zip(0..).map(|(tick, n)| (Topic::Tick, first.wrapping_add(n), tick_values(tick)));
    let evidence = slow.evidence.iter().map(|(id, evidence)| {
        let values = vec![
            Value::Flag(evidence.slip),
            Value::Flag(evidence.incipient),
            Value::Number(f64::from(evidence.confidence_permille) / 1e3),
            Value::Text(format!("{:?}", evidence.direction)),
            Value::Text(format!("{:?}", evidence.health)),
            Value::Number(evidence.raw.into()),
            Value::Number(seconds(evidence.decided_at)),
        ];
        (Topic::Detector(*id), slow.frame, values)
    });
    ticks.chain([(Topic::State, slow.frame, state)]).chain(evidence).collect()
}

fn tick_values(tick: &TickRecord) -> Vec<Value> {
    let names = |set: DetectorSet| Value::Text(names(set));
    let drive = match tick.drive {
        MotorDrive::Coast => 0.0,
        MotorDrive::Close(duty) => f64::from(duty.as_per_mille()) / 1e3,
        MotorDrive::Open(duty) => -f64::from(duty.as_per_mille()) / 1e3,
    };
    vec![
        Value::Number(mv_from_sample(tick.vibration).into()),
        Value::Number(f64::from(tick.outputs[0]) / 128.0),
        Value::Number(f64::from(tick.outputs[1]) / 128.0),
        Value::Number(drive),
        Value::Text(format!("{:?}", tick.source)),
        names(tick.said),
        names(tick.believed),
        names(tick.acted),
    ]
}

fn counter_values(counters: &Counters) -> Vec<Value> {
    [
        counters.frames,
        counters.frames_lost,
        counters.overruns,
        counters.ticks_late,
        counters.telemetry_dropped,
        counters.bad_frames,
        counters.commands_skipped,
        counters.control_us_max,
        counters.control_permille.into(),
    ]
    .map(|count| Value::Number(count.into()))
    .to_vec()
}
