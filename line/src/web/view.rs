//! The state of a board from its messages, and as JSON for the page.

use std::collections::{BTreeMap, VecDeque};
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use serde::Serialize;
use serde_json::{Value, json};
use tenax_frames::link::{Counts, Heard};
use tenax_frames::play::{self, Playing};
use tenax_frames::settings;
use tenax_frames::truth::{self, Bench, Truth};
use tenax_frames::words::{answer_words, seconds, why, words};
use tenax_hal_shim::channel::{CHANNELS, mv_from_sample};
use tenax_hal_shim::detector::{DetectorId, DetectorSet, Evidence};
use tenax_hal_shim::wire::{
    About, Answer, BadFrame, Counters, EventKind, Senses, Setting, Slow, TickRecord, Up,
};
use tenax_hal_shim::words::Fault;
use tenax_logic::setting::SettingId;

use super::source::News;
use crate::guide::selftest::{Session, Verdict};
use crate::tables::input;

/// Slow frames that are kept: 10 s.
const HISTORY: usize = 800;
/// Lines of the log that are kept.
const LOG: usize = 500;
/// Span of the rates.
const RATE_OVER: Duration = Duration::from_secs(2);
/// Time for each touch of the self-test, s: as in `tenax selftest`.
const TOUCH_S: u32 = 8;

/// Newest frames in which a detector said slip or warned, was believed, and was acted on; its last conclusion.
#[derive(Clone, Copy, Debug, Default, Serialize)]
struct Fate {
    said: Option<u32>,
    believed: Option<u32>,
    acted: Option<u32>,
    evidence: Option<Evidence>,
}

/// Readings of a slow frame: time (s), largest vibration envelope (mV), Ft/Fn, S2 in force, load (N), flexor and extensor (mV).
type Point = (f64, u32, Option<f64>, f64, Option<f64>, Option<i16>, Option<i16>);

#[derive(Default)]
pub struct View {
    /// Why there is no line.
    pub gone: Option<String>,
    /// Messages of another version came last.
    pub other_version: Option<String>,
    pub counts: Counts,
    pub bench: Option<Bench>,
    about: Option<About>,
    slow: Option<Slow>,
    senses: Option<Senses>,
    counters: Option<Counters>,
    settings: BTreeMap<u8, i32>,
    history: VecDeque<Point>,
    fates: [Fate; DetectorId::COUNT],
    /// Lost channels and capabilities, each with its words.
    faults: BTreeMap<String, String>,
    log: VecDeque<String>,
    /// Lines of the log so far, those that were dropped included.
    said: u64,
    truth: VecDeque<Truth>,
    playing: Option<Playing>,
    arrivals: VecDeque<(Instant, u32)>,
    heard: u64,
    selftest: Option<Session>,
    /// Self-tests that were begun.
    selftests: u64,
}

/// What a page has been told: points and true states up to a time (s), lines of the log, number of the self-test and its lines.
#[derive(Clone, Copy, Debug)]
pub struct After {
    points_s: f64,
    truth_s: f64,
    lines: u64,
    selftest: (u64, usize),
}

impl After {
    pub const NOTHING: Self = Self { points_s: f64::MIN, truth_s: f64::MIN, lines: 0, selftest: (0, 0) };
}

fn push<T>(all: &mut VecDeque<T>, most: usize, one: T) {
    if all.len() == most {
        all.pop_front();
    }
    all.push_back(one);
}

fn thousandths(value: impl Into<f64>) -> f64 {
    value.into() / 1e3
}

impl View {
    /// Updates it.
    pub fn take(&mut self, news: News) {
        if let Some(test) = &mut self.selftest {
            match &news {
                News::Frame(Ok(heard), ..) => test.take(Some(&heard.received.message)),
                News::Played(play::Told::Message(heard)) => test.take(Some(&heard.received.message)),
                News::Gone(why) => test.fail(&format!("the line is gone: {why}")),
                _ => test.take(None),
            }
        }
        match news {
            News::Open => {
                self.gone = None;
                self.say("the line is open".to_owned());
            }
            News::Gone(why) => {
                if self.gone.is_none() {
                    self.say(format!("the line is gone: {why}; it is opened again when it is back"));
                }
                self.gone = Some(why);
                self.arrivals.clear();
            }
            News::Frame(frame, counts, at) => {
                self.counts = counts;
                match frame {
                    Ok(heard) => self.hear(heard, at),
                    Err(bad @ BadFrame::Version(_)) => self.other_version = Some(why(bad)),
                    Err(_) => {}
                }
            }
            News::Scene(truth::Told::Truth(truth)) => {
                // A scene that was started anew begins at 0 again.
                if self.truth.back().is_some_and(|last| last.t_s > truth.t_s) {
                    self.truth.clear();
                }
                push(&mut self.truth, HISTORY, truth);
            }
            News::Scene(truth::Told::Bench(bench)) => self.bench = bench,
            News::Played(play::Told::Message(heard)) => {
                self.counts.messages += 1;
                self.counts.missed += u64::from(heard.missed);
                self.hear(*heard, Instant::now());
            }
            News::Played(play::Told::At(playing)) => self.playing = Some(playing),
            News::Played(play::Told::Again) => self.begin_anew(),
            News::Played(play::Told::Over) => {}
            News::Answered(command, Ok(answer)) => {
                self.say(format!("> {}", answer_words(&command, &answer)));
            }
            News::Answered(command, Err(why)) => self.say(format!("> {command:?}: {why}")),
        }
    }

    /// Adds a line to the log.
    pub fn say(&mut self, line: String) {
        push(&mut self.log, LOG, line);
        self.said += 1;
    }

    /// The settings as a file, once the board has sent its identity.
    pub fn backup(&self) -> Option<String> {
        let settings: Vec<Setting> =
            self.settings.iter().map(|(&id, &value)| Setting { id, value }).collect();
        self.about.as_ref().map(|about| settings::backup(about, &settings))
    }

    /// Self-test: `start`, with channels after it, `skip` or `stop`. Fails if that cannot be done now.
    pub fn selftest(&mut self, words: &[String]) -> anyhow::Result<()> {
        match words.split_first() {
            Some((first, channels)) if first == "start" => {
                if let Some(gone) = &self.gone {
                    bail!("no line: {gone}");
                }
                let flag = |id| self.setting(id).context("the board has not said its settings yet");
                let (head, no_wearer) = (flag(SettingId::Head)? != 0, flag(SettingId::NoWearer)? != 0);
                self.selftest = Some(Session::begin(channels, head, no_wearer, TOUCH_S)?);
                self.selftests += 1;
            }
            Some((first, [])) if first == "skip" => {
                self.selftest.as_mut().context("no test goes on")?.skip();
            }
            Some((first, [])) if first == "stop" => self.selftest = None,
            _ => bail!("write start, skip or stop"),
        }
        Ok(())
    }

    fn setting(&self, id: SettingId) -> Option<i32> {
        self.settings.get(&id.number()).copied()
    }

    fn t_s(&self) -> f64 {
        self.slow.as_ref().map_or(0.0, |slow| seconds(slow.frame))
    }

    /// Frames of the board's time, and slow frames that came, both a second of this computer's time.
    fn rates(&self) -> Option<(f64, f64)> {
        let ((first, from), (last, to)) = (self.arrivals.front()?, self.arrivals.back()?);
        let lasted_s = last.duration_since(*first).as_secs_f64();
        (lasted_s > 0.5).then(|| {
            (f64::from(to.wrapping_sub(*from)) / lasted_s, (self.arrivals.len() - 1) as f64 / lasted_s)
        })
    }

    fn hear(&mut self, Heard { received, missed }: Heard, at: Instant) {
        self.heard += 1;
        self.other_version = None;
        // Before the first message none is missed.
        if missed > 0 && self.heard > 1 {
            self.say(format!("{missed} messages missed"));
        }
        let message = received.message;
        match &message {
            Up::Raw(_) | Up::Taken { .. } => {}
            Up::Slow(slow) => self.slow(slow.clone(), at),
            Up::Senses(senses) => self.senses = Some(senses.clone()),
            Up::Counters(counters) => self.counters = Some(*counters),
            Up::About(about) => self.about(about),
            Up::Answer { answer: Answer::About(about), .. } => self.about(about),
            Up::Answer { answer: Answer::Setting(setting), .. } => self.set(&[*setting]),
            Up::Answer { answer: Answer::Settings(all), .. } => self.set(all),
            Up::Answer { answer: Answer::Last(last), .. } if last.after.is_some() && last.from == 0 => {
                self.say(words(&message));
            }
            Up::Answer { .. } => {}
            Up::Hello { .. } => {
                self.begin_anew();
                self.say(words(&message));
            }
            Up::Event(event) => {
                match event.kind {
                    EventKind::Fault(fault) => self.fault(&fault),
                    EventKind::Stroke { s2_permille, .. } => {
                        self.set(&[Setting { id: SettingId::S2.number(), value: s2_permille.into() }]);
                    }
                    _ => {}
                }
                self.say(words(&message));
            }
            Up::Saved { .. } | Up::Restored(_) => self.say(words(&message)),
        }
    }

    fn begin_anew(&mut self) {
        self.faults.clear();
        self.history.clear();
        self.fates = Default::default();
    }

    fn slow(&mut self, slow: Slow, now: Instant) {
        for id in DetectorId::ALL {
            let fate = &mut self.fates[id as usize];
            let is_in = |set: fn(&TickRecord) -> DetectorSet| {
                slow.ticks.iter().any(|tick| set(tick).contains(id)).then_some(slow.frame)
            };
            fate.said = is_in(|tick| tick.said).or(fate.said);
            fate.believed = is_in(|tick| tick.believed).or(fate.believed);
            fate.acted = is_in(|tick| tick.acted).or(fate.acted);
        }
        for (id, evidence) in &slow.evidence {
            self.fates[*id as usize].evidence = Some(*evidence);
        }
        let vibration = slow.ticks.iter().map(|tick| tick.vibration).max().unwrap_or(0);
        let point = (
            seconds(slow.frame),
            mv_from_sample(vibration),
            slow.forces.and_then(|forces| forces.ratio_permille).map(thousandths),
            thousandths(slow.s2_permille),
            slow.forces.map(|forces| thousandths(forces.load_mn)),
            slow.flexor_mv,
            slow.extensor_mv,
        );
        push(&mut self.history, HISTORY, point);
        self.arrivals.push_back((now, slow.frame));
        while self.arrivals.front().is_some_and(|(at, _)| now.duration_since(*at) > RATE_OVER) {
            self.arrivals.pop_front();
        }
        self.slow = Some(slow);
    }

    fn about(&mut self, about: &About) {
        self.set(&about.settings);
        self.about = Some(about.clone());
    }

    fn set(&mut self, all: &[Setting]) {
        self.settings.extend(all.iter().map(|setting| (setting.id, setting.value)));
    }

    fn fault(&mut self, fault: &Fault) {
        let name = |channel: u8| CHANNELS.get(usize::from(channel)).map_or("channel", |channel| channel.name);
        match *fault {
            Fault::SensorLost { channel, reason } => {
                self.faults.insert(name(channel).to_owned(), format!("{}: {reason:?}", name(channel)));
            }
            Fault::SensorBack { channel } => _ = self.faults.remove(name(channel)),
            Fault::CapabilityLost(capability) => {
                self.faults.insert(format!("{capability:?}"), format!("no {capability:?}"));
            }
            Fault::CapabilityBack(capability) => _ = self.faults.remove(&format!("{capability:?}")),
            _ => {}
        }
    }

    /// The state, and what is new for a page, which is noted in `after`.
    pub fn event(&self, place: &str, after: &mut After) -> Value {
        let truth_s = self.truth.back().map_or(f64::MIN, |truth| truth.t_s);
        // A board or a scene that started anew counts from 0 again.
        if self.t_s() < after.points_s {
            after.points_s = f64::MIN;
        }
        if truth_s < after.truth_s {
            after.truth_s = f64::MIN;
        }
        let points: Vec<&Point> = self.history.iter().filter(|point| point.0 > after.points_s).collect();
        let truths = self.truth.iter().filter(|truth| truth.t_s > after.truth_s);
        let truths: Vec<_> =
            truths.map(|truth| (truth.t_s, truth.slide_mm_s, truth.needed_n, truth.grip_n)).collect();
        let new = usize::try_from(self.said - after.lines).unwrap_or(LOG).min(self.log.len());
        let log: Vec<&str> =
            self.log.iter().skip(self.log.len() - new).map(|line| line.trim_start()).collect();
        // Only a test injects slip.
        let detectors: Vec<_> = DetectorId::ALL
            .into_iter()
            .filter(|&id| id != DetectorId::Injected)
            .map(|id| (id.name(), self.fates[id as usize]))
            .collect();
        let slow = self.slow.as_ref();
        let sensors = self.senses.as_ref().map(|senses| {
            let all = CHANNELS.iter().zip(&senses.samples);
            all.map(|(channel, &sample)| (channel.name, mv_from_sample(sample))).collect::<Vec<_>>()
        });
        let event = json!({
            "place": place,
            "gone": self.gone,
            "other_version": self.other_version,
            "t_s": self.t_s(),
            "frame": slow.map(|slow| slow.frame),
            "mode": slow.map(|slow| format!("{:?}", slow.mode)),
            "line": slow.map(|slow| format!("{:?}", slow.line)),
            "flexor_mv": slow.and_then(|slow| slow.flexor_mv),
            "extensor_mv": slow.and_then(|slow| slow.extensor_mv),
            "wearer_active": slow.is_some_and(|slow| slow.wearer_active),
            "s1_mv": self.setting(SettingId::S1),
            "emg_on_mv": self.setting(SettingId::EmgOn),
            "sensors": sensors,
            "detectors": detectors,
            "faults": self.faults.values().collect::<Vec<_>>(),
            "rates": self.rates(),
            "missed": self.counts.missed,
            "bad_frames": self.counts.bad_frames,
            "counters": self.counters.unwrap_or_default(),
            "points": points,
            "log": log,
            "truth": self.truth.back(),
            "truths": truths,
            "bench": self.bench.as_ref().map(|bench| &bench.keys),
            "playing": self.playing,
            "selftest": self.selftest.as_ref().map(|test| self.selftest_event(test, after.selftest)),
        });
        let lines = self.selftest.as_ref().map_or(0, |test| test.said().len());
        *after = After { points_s: self.t_s(), truth_s, lines: self.said, selftest: (self.selftests, lines) };
        event
    }

    /// The state of the self-test; its lines and verdicts only where there are new ones.
    fn selftest_event(&self, session: &Session, (number, lines): (u64, usize)) -> Value {
        let (test, said, number_is_new) = (session.test(), session.said(), number != self.selftests);
        let known = if number_is_new { 0 } else { lines.min(said.len()) };
        let result = |&channel: &usize| {
            let verdict = test.verdict(channel);
            let passes = verdict.map(|verdict| matches!(verdict, Verdict::Pass(_)));
            let words = verdict.map(|verdict| test.words(channel, verdict));
            (CHANNELS[channel].name, input(channel), passes, words)
        };
        let is_new = known < said.len() || number_is_new;
        json!({
            "number": self.selftests,
            "prompt": test.prompt(),
            "over": test.is_over(),
            "passes": test.passes(),
            "failed": session.failed(),
            "level": test.level(),
            "lines": &said[known..],
            "results": is_new.then(|| test.channels().iter().map(result).collect::<Vec<_>>()),
        })
    }

    /// Every setting with value, unit, range in force, default and meaning.
    pub fn settings(&self, control: bool) -> Value {
        let trusted = self.setting(SettingId::LineTrusted) == Some(1);
        let rows = SettingId::ALL.map(|id| {
            let row = id.row();
            let (min, max) = row.range_in_force(trusted).into_inner();
            json!({
                "name": row.name, "unit": row.unit, "min": min, "max": max, "default": row.default,
                "meaning": row.meaning, "value": self.setting(id),
            })
        });
        json!({ "control": control, "settings": rows.as_slice() })
    }
}
