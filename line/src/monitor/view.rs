//! What is known of a board from what it has said: all that the screen shows.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::time::{Duration, Instant};

use tenax_hal_shim::channel::{CHANNELS, mv_from_sample};
use tenax_hal_shim::detector::{DetectorId, DetectorSet, Evidence};
use tenax_hal_shim::wire::{
    About, Answer, BadFrame, Counters, Down, EventKind, Senses, Slow, TickRecord, Up,
};
use tenax_hal_shim::words::Fault;
use tenax_logic::setting::SettingId;

use super::source::News;
use tenax_frames::link::{Counts, Heard};
use tenax_frames::play::Playing;
use tenax_frames::truth::{Bench, Truth};
use tenax_frames::words::seconds;
use tenax_frames::words::{AnswerWords, Words, why};

/// Slow frames whose readings are drawn: ten seconds.
pub const HISTORY: usize = 800;
/// Lines of the log that are kept.
const LOG: usize = 500;
/// Over how long rates are taken.
const RATE_OVER: Duration = Duration::from_secs(2);

/// The readings of a slow frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct Point {
    /// When, s of the board's time.
    pub t_s: f64,
    /// The largest envelope, mV.
    pub vibration_mv: f64,
    /// Ft/Fn.
    pub ratio: Option<f64>,
    /// S2 in force.
    pub s2: f64,
    pub load_n: Option<f64>,
    pub flexor_mv: Option<i16>,
    pub extensor_mv: Option<i16>,
}

/// When a detector was last something.
#[derive(Clone, Copy, Debug, Default)]
pub struct Fate {
    /// It said slip, or warned.
    pub said: Option<u32>,
    pub believed: Option<u32>,
    /// The reflex acted on it.
    pub acted: Option<u32>,
    /// What it concluded last.
    pub evidence: Option<Evidence>,
}

/// What is known of a board.
#[derive(Default)]
pub struct View {
    /// Why there is no line, if there is none.
    pub gone: Option<String>,
    pub slow: Option<Slow>,
    pub senses: Option<Senses>,
    pub counters: Option<Counters>,
    pub about: Option<About>,
    /// Settings whose value was said.
    pub settings: BTreeMap<u8, i32>,
    /// Readings, the oldest first.
    pub history: VecDeque<Point>,
    pub fates: [Fate; DetectorId::COUNT],
    /// What is wrong now, in words.
    pub faults: BTreeSet<String>,
    /// What happened, the oldest first.
    pub log: VecDeque<String>,
    /// What was counted on the line.
    pub counts: Counts,
    /// What really happens, if there is a scene that tells, the oldest first.
    pub truth: VecDeque<Truth>,
    /// What can be done at the scene's bench, if there is one.
    pub bench: Option<Bench>,
    /// Where the recording is, if it is one that is watched.
    pub playing: Option<Playing>,
    /// Messages of another version were heard.
    pub other_version: Option<String>,
    said: u64,
    arrivals: VecDeque<(Instant, u32)>,
    heard: u64,
}

impl View {
    /// Takes in what the line tells.
    pub fn take(&mut self, news: News) {
        match news {
            News::Open => {
                self.gone = None;
                self.say("the line is open");
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
                    Err(bad) => self.skip(bad),
                }
            }
            News::Truth(truth) => {
                // A scene that was started anew begins at 0 again.
                if self.truth.back().is_some_and(|last| last.t_s > truth.t_s) {
                    self.truth.clear();
                }
                if self.truth.len() == HISTORY {
                    self.truth.pop_front();
                }
                self.truth.push_back(truth);
            }
            News::Bench(bench) => self.bench = bench,
            News::Playing(playing) => self.playing = Some(playing),
            News::Rewound => self.begin_anew(),
            News::Answered(command, answer) => self.answered(&command, answer),
        }
    }

    /// A line of the log.
    pub fn say(&mut self, line: impl Into<String>) {
        if self.log.len() == LOG {
            self.log.pop_front();
        }
        self.log.push_back(line.into());
        self.said += 1;
    }

    /// Lines of the log so far, those that are kept no more included.
    pub const fn said(&self) -> u64 {
        self.said
    }

    /// The time of the last slow frame, s.
    pub fn t_s(&self) -> f64 {
        self.slow.as_ref().map_or(0.0, |slow| seconds(slow.frame))
    }

    /// A setting in force, if it was said.
    pub fn setting(&self, id: SettingId) -> Option<i32> {
        self.settings.get(&id.number()).copied()
    }

    /// Frames of the board's time that went by in a second here, and slow frames that came.
    pub fn rates(&self) -> Option<(f64, f64)> {
        let ((first, from), (last, to)) = (self.arrivals.front()?, self.arrivals.back()?);
        let lasted_s = last.duration_since(*first).as_secs_f64();
        (lasted_s > 0.5).then(|| {
            (f64::from(to.wrapping_sub(*from)) / lasted_s, (self.arrivals.len() - 1) as f64 / lasted_s)
        })
    }

    fn hear(&mut self, Heard { received, missed }: Heard, at: Instant) {
        self.heard += 1;
        self.other_version = None;
        // Who joins in the middle has missed nothing.
        if missed > 0 && self.heard > 1 {
            self.say(format!("{missed} messages missed"));
        }
        match &received.message {
            Up::Slow(slow) => self.slow(slow.clone(), at),
            Up::Senses(senses) => self.senses = Some(senses.clone()),
            Up::Counters(counters) => self.counters = Some(*counters),
            Up::About(about) => self.about(about.clone()),
            Up::Answer { answer: Answer::Last(last), .. } if last.after.is_some() && last.from == 0 => {
                self.say(Words(&received.message).to_string());
            }
            Up::Answer { answer, .. } => self.learn(answer),
            Up::Hello { .. } => {
                self.begin_anew();
                self.say(Words(&received.message).to_string());
            }
            Up::Event(event) => {
                match event.kind {
                    EventKind::Fault(fault) => self.fault(&fault),
                    EventKind::Stroke { s2_permille, .. } => {
                        _ = self.settings.insert(SettingId::S2.number(), s2_permille.into());
                    }
                    _ => {}
                }
                self.say(Words(&received.message).to_string());
            }
            Up::Raw(_) | Up::Taken { .. } => {}
            message => self.say(Words(message).to_string()),
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
        if self.history.len() == HISTORY {
            self.history.pop_front();
        }
        self.history.push_back(Point {
            t_s: seconds(slow.frame),
            vibration_mv: f64::from(mv_from_sample(vibration)),
            ratio: slow
                .forces
                .and_then(|forces| forces.ratio_permille)
                .map(|permille| f64::from(permille) / 1e3),
            s2: f64::from(slow.s2_permille) / 1e3,
            load_n: slow.forces.map(|forces| f64::from(forces.load_mn) / 1e3),
            flexor_mv: slow.flexor_mv,
            extensor_mv: slow.extensor_mv,
        });
        self.arrivals.push_back((now, slow.frame));
        while self.arrivals.front().is_some_and(|(at, _)| now.duration_since(*at) > RATE_OVER) {
            self.arrivals.pop_front();
        }
        self.slow = Some(slow);
    }

    fn about(&mut self, about: About) {
        self.settings.extend(about.settings.iter().map(|setting| (setting.id, setting.value)));
        self.about = Some(about);
    }

    fn learn(&mut self, answer: &Answer) {
        match answer {
            Answer::About(about) => self.about(about.clone()),
            Answer::Setting(setting) => _ = self.settings.insert(setting.id, setting.value),
            Answer::Settings(all) => {
                self.settings.extend(all.iter().map(|setting| (setting.id, setting.value)))
            }
            _ => {}
        }
    }

    fn answered(&mut self, command: &Down, answer: Result<Answer, String>) {
        match answer {
            Ok(answer) => self.say(format!("> {}", AnswerWords(command, &answer))),
            Err(why) => self.say(format!("> {command:?}: {why}")),
        }
    }

    fn fault(&mut self, fault: &Fault) {
        let name = |channel: u8| CHANNELS.get(usize::from(channel)).map_or("channel", |channel| channel.name);
        match *fault {
            Fault::SensorLost { channel, reason } => {
                self.faults.retain(|fault| !fault.starts_with(&format!("{}: ", name(channel))));
                self.faults.insert(format!("{}: {reason:?}", name(channel)));
            }
            Fault::SensorBack { channel } => {
                self.faults.retain(|fault| !fault.starts_with(&format!("{}: ", name(channel))));
            }
            Fault::CapabilityLost(capability) => _ = self.faults.insert(format!("no {capability:?}")),
            Fault::CapabilityBack(capability) => _ = self.faults.remove(&format!("no {capability:?}")),
            _ => {}
        }
    }

    fn skip(&mut self, bad: BadFrame) {
        if matches!(bad, BadFrame::Version(_)) {
            self.other_version = Some(why(bad));
        }
    }
}
