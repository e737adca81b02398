//! The state of a board for the page, as JSON: the page merges each change as [`View`] does.

use std::collections::{BTreeMap, VecDeque};
use std::time::SystemTime;

use anyhow::{Context, bail};
use serde_json::{Map, Value, json};
use tenax_frames::link::{Counts, Heard};
use tenax_frames::settings;
use tenax_frames::words::{answer_words, in_words, line_words, seconds, why, words};
use tenax_hal_shim::channel::{CHANNELS, mv_from_sample};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::wire::{About, Answer, BadFrame, Down, EventKind, Setting, Slow, TickRecord, Up};
use tenax_hal_shim::words::{Fault, GripMode};
use tenax_logic::setting::SettingId;

use crate::selftest::{Selftest, Verdict};
use crate::tables::input;

const HISTORY: usize = 800;
const LOG: usize = 500;
/// Time for each touch of the self-test, s: as in `tenax selftest`.
const TOUCH_S: u32 = 8;

#[derive(Default)]
pub struct View {
    state: Map<String, Value>,
    changes: Vec<Value>,
    log: VecDeque<String>,
    points: VecDeque<Value>,
    pub counts: Counts,
    about: Option<About>,
    settings: BTreeMap<u8, i32>,
    faults: BTreeMap<String, String>,
    selftest: Option<Selftest>,
}

fn push<T>(all: &mut VecDeque<T>, most: usize, one: T) {
    if all.len() == most {
        all.pop_front();
    }
    all.push_back(one);
}

impl View {
    pub const fn state(&self) -> &Map<String, Value> {
        &self.state
    }

    /// The whole state, with which a page begins.
    pub fn whole(&self) -> Value {
        let mut state = self.state.clone();
        state.insert("log".to_owned(), json!(self.log));
        state.insert("points".to_owned(), json!(self.points));
        Value::Object(state)
    }

    /// Changes since the last call, each an object.
    pub fn take_changes(&mut self) -> Vec<Value> {
        std::mem::take(&mut self.changes)
    }

    /// Merges a change, an object, into the state.
    pub fn tell(&mut self, change: Value) {
        self.state.extend(change.as_object().cloned().unwrap_or_default());
        self.changes.push(change);
    }

    pub fn say(&mut self, line: &str) {
        push(&mut self.log, LOG, line.trim_start().to_owned());
        self.tell(json!({ "log": [line.trim_start()] }));
    }

    pub fn open(&mut self) {
        self.tell(json!({ "gone": null }));
        self.say("the line is open");
    }

    pub fn gone(&mut self, why: &str) {
        if self.state.get("gone").is_none_or(Value::is_null) {
            self.say(&format!("the line is gone: {why}; it is opened again when it is back"));
        }
        if let Some(test) = &mut self.selftest {
            test.fail(&format!("the line is gone: {why}"));
            self.tell_selftest();
        }
        self.tell(json!({ "gone": why }));
    }

    /// A message, or why a frame is none; the counts so far.
    pub fn frame(&mut self, frame: Result<&Heard, BadFrame>, counts: Counts) {
        if counts.bad_frames != self.counts.bad_frames || counts.missed != self.counts.missed {
            self.tell(json!({ "missed": counts.missed, "bad_frames": counts.bad_frames }));
        }
        self.counts = counts;
        match frame {
            Ok(heard) => self.hear(heard),
            Err(bad @ BadFrame::Version(_)) => self.tell(json!({ "other_version": why(bad) })),
            Err(_) => {}
        }
    }

    pub fn answered(&mut self, command: &Down, answer: &Answer) {
        self.say(&format!("> {}", answer_words(command, answer)));
    }

    pub fn hear(&mut self, Heard { received, missed }: &Heard) {
        if self.state.get("other_version").is_some_and(Value::is_string) {
            self.tell(json!({ "other_version": null }));
        }
        if *missed > 0 {
            self.say(&format!("{missed} messages missed"));
        }
        let message = &received.message;
        if let Some(test) = &mut self.selftest {
            let had_failed = test.failed.is_some();
            test.take(message);
            if matches!(message, Up::Senses(_)) || test.failed.is_some() != had_failed {
                self.tell_selftest();
            }
        }
        match message {
            Up::Slow(slow) => self.slow(slow),
            Up::Senses(senses) => {
                let all = CHANNELS.iter().zip(&senses.samples);
                let sensors: Vec<_> =
                    all.map(|(channel, &sample)| (channel.name, mv_from_sample(sample))).collect();
                self.tell(json!({ "sensors": sensors }));
            }
            Up::Counters(counters) => self.tell(json!({ "counters": counters })),
            Up::About(about) | Up::Answer { answer: Answer::About(about), .. } => {
                self.about = Some(about.clone());
                self.set(&about.settings);
            }
            Up::Answer { answer: Answer::Setting(setting), .. } => self.set(&[*setting]),
            Up::Answer { answer: Answer::Settings(all), .. } => self.set(all),
            Up::Hello { .. } => self.begin_anew(),
            Up::Event(event) => match event.kind {
                EventKind::Fault(fault) => self.fault(&fault),
                EventKind::Pulse { margin_mn, believed, .. } => {
                    let why = why_closed(margin_mn, believed);
                    self.tell(json!({ "why": format!("{:.2} s: {why}", seconds(event.frame)) }));
                }
                EventKind::Mode { to: GripMode::Wearer, .. }
                    if self.state.get("why").is_none_or(Value::is_null) =>
                {
                    let why = "the wearer moves the hand, and the reflex is silent.";
                    self.tell(json!({ "why": format!("{:.2} s: {why}", seconds(event.frame)) }));
                }
                EventKind::Stroke { s2_permille, .. } => {
                    self.set(&[Setting { id: SettingId::S2.number(), value: s2_permille.into() }]);
                }
                _ => {}
            },
            _ => {}
        }
        let is_logged = match message {
            Up::Answer { answer: Answer::Last(last), .. } => last.after.is_some() && last.from == 0,
            Up::Hello { .. } | Up::Event(_) | Up::Saved { .. } | Up::Restored(_) => true,
            _ => false,
        };
        if is_logged {
            self.say(&words(message));
        }
    }

    pub fn begin_anew(&mut self) {
        self.faults.clear();
        self.points.clear();
        self.tell(json!({ "restarted": true, "faults": [], "why": null }));
    }

    fn slow(&mut self, slow: &Slow) {
        let vibration = slow.ticks.iter().map(|tick| tick.vibration).max().unwrap_or(0);
        // Time (s), largest vibration envelope (mV), Ft/Fn, S2 in force, load (N), flexor and extensor (mV), direction of the shear (rad),
        // margin (N).
        let point = json!([
            seconds(slow.frame),
            mv_from_sample(vibration),
            slow.forces.and_then(|forces| forces.ratio_permille).map(|permille| f64::from(permille) / 1e3),
            f64::from(slow.s2_permille) / 1e3,
            slow.forces.map(|forces| f64::from(forces.load_mn) / 1e3),
            slow.flexor_mv,
            slow.extensor_mv,
            slow.shear_mrad.map(|mrad| f64::from(mrad) / 1e3),
            slow.forces.and_then(|forces| forces.margin_mn(slow.s2_permille)).map(|mn| f64::from(mn) / 1e3),
        ]);
        push(&mut self.points, HISTORY, point.clone());
        // Only a test injects slip.
        let detectors = DetectorId::ALL.into_iter().filter(|&id| id != DetectorId::Injected).map(|id| {
            let ever =
                |set: fn(&TickRecord) -> DetectorSet| slow.ticks.iter().any(|tick| set(tick).contains(id));
            let evidence = slow.evidence.iter().find(|(own, _)| *own == id).map(|(_, evidence)| evidence);
            (id.name(), ever(|tick| tick.said), ever(|tick| tick.believed), ever(|tick| tick.acted), evidence)
        });
        self.tell(json!({
            "t_s": seconds(slow.frame),
            "frame": slow.frame,
            "mode": format!("{:?}", slow.mode),
            "line": line_words(slow.line),
            "wearer_active": slow.wearer_active,
            "points": [point],
            "detectors": detectors.collect::<Vec<_>>(),
        }));
    }

    fn set(&mut self, all: &[Setting]) {
        self.settings.extend(all.iter().map(|setting| (setting.id, setting.value)));
        let [s1_mv, emg_on_mv] = [SettingId::S1, SettingId::EmgOn].map(|id| self.setting(id));
        self.tell(json!({ "s1_mv": s1_mv, "emg_on_mv": emg_on_mv }));
    }

    fn setting(&self, id: SettingId) -> Option<i32> {
        self.settings.get(&id.number()).copied()
    }

    fn fault(&mut self, fault: &Fault) {
        let (of, is_lost) = match *fault {
            Fault::SensorLost { channel, .. } => (format!("channel {channel}"), true),
            Fault::SensorBack { channel } => (format!("channel {channel}"), false),
            Fault::CapabilityLost(own) => (format!("{own:?}"), true),
            Fault::CapabilityBack(own) => (format!("{own:?}"), false),
            _ => return,
        };
        if is_lost {
            self.faults.insert(of, in_words(fault));
        } else {
            self.faults.remove(&of);
        }
        self.tell(json!({ "faults": self.faults.values().collect::<Vec<_>>() }));
    }

    pub fn backup(&self, now: SystemTime) -> Option<String> {
        let settings: Vec<Setting> =
            self.settings.iter().map(|(&id, &value)| Setting { id, value }).collect();
        self.about.as_ref().map(|about| settings::backup(about, &settings, now))
    }

    /// Every setting with value, unit, range in force, default and meaning.
    pub fn settings(&self, control: bool) -> Value {
        let rows = SettingId::ALL.map(|id| {
            let row = id.row();
            let (min, max) = row.range().into_inner();
            json!({
                "name": row.name, "unit": row.unit, "min": min, "max": max, "default": row.default,
                "meaning": row.meaning, "value": self.setting(id),
            })
        });
        json!({ "control": control, "settings": rows.as_slice() })
    }

    /// Self-test: `start`, with channels after it, `skip` or `stop`. Fails if that cannot be done now.
    pub fn selftest(&mut self, words: &[String]) -> anyhow::Result<()> {
        match words.split_first() {
            Some((first, channels)) if first == "start" => {
                if let Some(gone) = self.state.get("gone").and_then(Value::as_str) {
                    bail!("no line: {gone}");
                }
                let flag = |id| self.setting(id).context("the board has not said its settings yet");
                let (head, no_wearer) = (flag(SettingId::Head)? != 0, flag(SettingId::NoWearer)? != 0);
                self.selftest = Some(Selftest::named(channels, head, no_wearer, TOUCH_S)?);
            }
            Some((first, [])) if first == "skip" => {
                self.selftest.as_mut().context("no test goes on")?.skip();
            }
            Some((first, [])) if first == "stop" => self.selftest = None,
            _ => bail!("write start, skip or stop"),
        }
        self.tell_selftest();
        Ok(())
    }

    fn tell_selftest(&mut self) {
        let state = self.selftest.as_ref().map(|test| {
            let result = |&channel: &usize| {
                let verdict = test.verdicts[channel];
                let passes = verdict.map(|verdict| matches!(verdict, Verdict::Pass(_)));
                let words = verdict.map(|verdict| verdict.words(channel));
                (CHANNELS[channel].name, input(channel), passes, words)
            };
            json!({
                "prompt": test.prompt(),
                "over": test.is_over(),
                "passes": test.passes(),
                "failed": test.failed,
                "level": test.level(),
                "lines": test.said,
                "results": test.channels.iter().map(result).collect::<Vec<_>>(),
            })
        });
        self.tell(json!({ "selftest": state }));
    }
}

/// Why the reflex closed the hand, for somebody who has read nothing.
fn why_closed(margin_mn: Option<i32>, believed: DetectorSet) -> String {
    let hears = |id: DetectorId| match id {
        DetectorId::S1 => "the films heard the vibration of a slip (s1)",
        DetectorId::S2 => "the shear came near what friction holds (s2)",
        DetectorId::Hebbian => "films and gauges together showed a slip (hebbian)",
        DetectorId::Mlp => "the force array showed a slip (mlp)",
        DetectorId::Photoelastic => "the light in the pad flickered (photoelastic)",
        DetectorId::Injected => "a test said so",
    };
    let all: Vec<&str> = DetectorId::ALL.into_iter().filter(|id| believed.contains(*id)).map(hears).collect();
    let cause = if all.is_empty() { "the margin was used up".to_owned() } else { all.join(", and ") };
    let margin = match margin_mn {
        Some(mn @ 0..) => format!("{:.2} N of margin was left", f64::from(mn) / 1e3),
        Some(mn) => format!("{:.2} N of margin was missing", f64::from(-mn) / 1e3),
        None => "the margin was not known".to_owned(),
    };
    format!("the reflex closed the hand, because {cause}; {margin}.")
}

/// The command of a page's path: `/zero`, `/set/s1-mv/120`.
pub fn command(path: &str) -> Option<Down> {
    match path {
        "/zero" => Some(Down::Zero),
        "/calibrate" => Some(Down::CalibrateEmg),
        _ => {
            let (name, value) = path.strip_prefix("/set/")?.split_once('/')?;
            let id = SettingId::by_name(name)?;
            Some(Down::Set(Setting { id: id.number(), value: value.parse().ok()? }))
        }
    }
}
