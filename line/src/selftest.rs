//! Tests every sensor's wire: at rest each has its level, and what is touched is what moves.
//! A prompt begins with the verb and the channel's name: it can be piped to a served scene's bench.

use anyhow::bail;
use serde::Serialize;
use tenax_hal_shim::channel::{
    CHANNELS, COUNT, Channel, FRAME_HZ, MOTOR_CURRENT, OPENING, PVDF, PVDF_COUNT, REFERENCE_MV, Role,
    SAMPLE_MAX, by_name,
};
use tenax_hal_shim::wire::{Senses, Up};

use crate::tables::input;

/// Time at rest, and of a touch once something moves, frames.
const REST: u32 = 2 * FRAME_HZ;
const WATCHED: u32 = FRAME_HZ / 2;
/// Before the next prompt nothing may move for this many readings; at most for this time, frames.
const STILL: usize = 20;
const STILL_WITHIN: u32 = 3 * FRAME_HZ;
/// A board that is silent for longer sends no readings.
const SILENCE: u32 = 4 * FRAME_HZ;
/// Range of a working wire, mV: films have no narrower one of their own.
const DEAD_MV: f64 = 45.0;
const SHORT_MV: f64 = 3_255.0;
/// Ratio of a move to the noise at rest.
const OVER_NOISE: f64 = 3.0;
/// Two wires touch if their readings differ by less than this part of their move, and both move by this part of what moves most.
const ALIKE: f64 = 0.25;
const ALIKE_LOUD: f64 = 0.7;
/// A channel of the asked kind that moved by this part of the loudest is the one that moved.
const BROTHERS: f64 = 0.5;
const REST_PROMPT: &str = "Touch nothing and relax for 2 s.";

/// The least move of a touched sensor; and how far below and above its rest it may stand, mV.
const fn demands(role: Role) -> (f64, [f64; 2]) {
    match role {
        Role::Vibration => (60.0, [150.0, 150.0]),
        // A bridge's offset; a cell's null.
        Role::Strain => (40.0, [700.0, 700.0]),
        Role::Force => (60.0, [80.0, 200.0]),
        Role::Taxel => (60.0, [80.0, 250.0]),
        // The other muscle's crosstalk is less; the tone of a muscle at rest.
        Role::Muscle => (150.0, [60.0, 300.0]),
        Role::Photoelastic => (60.0, [f64::INFINITY; 2]),
        Role::Hand => (150.0, [60.0, 60.0]),
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// It moved by this, or stands right and cannot be touched.
    Pass(f64),
    Dead(f64),
    Shorted(f64),
    Stuck(f64),
    /// It does not stand where its kind does.
    Off(f64),
    Silent,
    Moved(usize),
    Bridged(usize),
}

impl Verdict {
    pub fn words(self, channel: usize) -> String {
        let Channel { rest_mv, name, .. } = CHANNELS[channel];
        match self {
            Self::Pass(mv) => format!("{name}: {mv:.0} mV"),
            Self::Dead(mv) => format!("{mv:.0} mV: a cut wire, a short to ground, or no supply"),
            Self::Shorted(mv) => format!("{mv:.0} mV: a short to the supply, or out of range"),
            Self::Stuck(mv) => format!("always {mv:.0} mV: an open switch, or a select line"),
            Self::Off(mv) => format!("rests at {mv:.0} mV, not {rest_mv}: another's wire, or reference"),
            Self::Silent => "nothing moves: wire cut at the sensor, or deaf".to_owned(),
            Self::Moved(other) => format!("{} moves in its place", wire(other)),
            Self::Bridged(other) => format!("{} does the same: the two wires touch", wire(other)),
        }
    }
}

/// A channel and its input: `fsr_a (switch A, 12)`.
fn wire(channel: usize) -> String {
    format!("{} ({})", CHANNELS[channel].name, input(channel))
}

/// Readings of all channels, mV, then the films' envelopes.
type Row = [f64; COUNT + PVDF_COUNT];

fn mean(rows: &[Row]) -> Row {
    std::array::from_fn(|n| rows.iter().map(|row| row[n]).sum::<f64>() / rows.len() as f64)
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Level {
    pub mv: f64,
    /// Distance from its rest, a film's by its envelope, and the distance that is a touch, mV.
    pub moved_mv: f64,
    pub needed_mv: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    Rest,
    /// Place in the list of channels; whether it is asked for again; the frame in which something began to move.
    Asked(usize, bool, Option<u32>),
    /// Until nothing moves; then this place is asked for.
    Stills(usize, bool),
    Over,
}

pub struct Selftest {
    roles: [Role; COUNT],
    pub channels: Vec<usize>,
    /// None: the channel was not asked for.
    pub verdicts: [Option<Verdict>; COUNT],
    pub said: Vec<String>,
    pub failed: Option<String>,
    /// The first slow frame after the last reading.
    silent_from: Option<u32>,
    limit: u32,
    step: Step,
    began: Option<u32>,
    last: u32,
    rows: Vec<Row>,
    /// Mean of the last readings in which nothing moved: what is held, creeps or drifts is no touch.
    rest_mv: Row,
    noise_mv: Row,
}

impl Selftest {
    /// A test of channels of these names or prefixes, each touched within `limit_s`. `head`: a photoelastic head is in the place of a
    /// film. Without names: all, but for a gripper without a wearer no muscles. Fails on a name that fits none.
    pub fn named(words: &[String], head: bool, no_wearer: bool, limit_s: u32) -> anyhow::Result<Self> {
        let mut channels = named(words)?;
        if words.is_empty() && no_wearer {
            channels.retain(|&channel| Role::of(channel, head) != Role::Muscle);
        }
        Ok(Self {
            roles: std::array::from_fn(|channel| Role::of(channel, head)),
            channels,
            verdicts: [None; COUNT],
            said: vec![
                "The hand is empty: the reflex may close it on what is pressed.".to_owned(),
                REST_PROMPT.to_owned(),
            ],
            failed: None,
            silent_from: None,
            limit: limit_s * FRAME_HZ,
            step: Step::Rest,
            began: None,
            last: 0,
            rows: Vec::new(),
            rest_mv: [0.0; COUNT + PVDF_COUNT],
            noise_mv: [0.0; COUNT + PVDF_COUNT],
        })
    }

    pub fn is_over(&self) -> bool {
        self.step == Step::Over
    }

    pub fn prompt(&self) -> String {
        match self.step {
            Step::Rest => REST_PROMPT.to_owned(),
            Step::Asked(n, again, _) => self.asks(n, again),
            Step::Stills(..) => "Let go: the next follows when nothing moves".to_owned(),
            Step::Over => "The test is over".to_owned(),
        }
    }

    pub fn level(&self) -> Option<Level> {
        let Step::Asked(n, ..) = self.step else { return None };
        let (asked, row) = (self.channels[n], self.rows.last()?);
        let needed_mv = demands(self.roles[asked]).0.max(OVER_NOISE * self.noise_mv[asked]);
        Some(Level { mv: row[asked], moved_mv: self.moved(row, asked) * needed_mv, needed_mv })
    }

    pub fn skip(&mut self) {
        if let Step::Asked(n, ..) = self.step {
            self.begin(Step::Stills(n + 1, false), self.last);
            self.said.push("   left out".to_owned());
        }
    }

    /// Takes a message. A board that sends no readings or starts anew fails the test.
    pub fn take(&mut self, message: &Up) {
        match message {
            _ if self.is_over() || self.failed.is_some() => {}
            Up::Senses(senses) => self.hear(senses),
            Up::Hello { .. } if self.began.is_some() => {
                self.fail("the board was switched on anew: start again");
            }
            Up::Slow(slow) => {
                let from = *self.silent_from.get_or_insert(slow.frame);
                if slow.frame.wrapping_sub(from) > SILENCE {
                    self.fail("the board sends no readings");
                }
            }
            _ => {}
        }
    }

    pub fn fail(&mut self, why: &str) {
        if !self.is_over() {
            self.failed.get_or_insert_with(|| why.to_owned());
        }
    }

    pub fn hear(&mut self, senses: &Senses) {
        let since = senses.frame.wrapping_sub(*self.began.get_or_insert(senses.frame));
        let mut row = [0.0; COUNT + PVDF_COUNT];
        for (mv, sample) in row.iter_mut().zip(senses.samples.iter().chain(&senses.films)) {
            *mv = f64::from(*sample) * f64::from(REFERENCE_MV) / f64::from(SAMPLE_MAX);
        }
        (self.last, self.silent_from) = (senses.frame, None);
        self.rows.push(row);
        match self.step {
            Step::Rest if since >= REST => {
                self.judge_rest();
                self.ask(0, false, senses.frame);
            }
            Step::Asked(n, again, moved) => {
                let moved = moved.or_else(|| self.moves(&row).then_some(senses.frame));
                self.step = Step::Asked(n, again, moved);
                let watched = moved.is_some_and(|at| senses.frame.wrapping_sub(at) >= WATCHED);
                if watched || since >= self.limit {
                    self.touched(n, again, senses.frame);
                }
            }
            Step::Stills(n, again) => {
                let last = self.rows.len().saturating_sub(STILL);
                self.rows.drain(..last);
                let mean = mean(&self.rows);
                let from_mean = |row: &Row| std::array::from_fn(|n| self.rest_mv[n] + row[n] - mean[n]);
                let is_still = || self.rows.iter().all(|row| !self.moves(&from_mean(row)));
                if self.rows.len() >= STILL && (since >= STILL_WITHIN || is_still()) {
                    self.rest_mv = mean;
                    self.ask(n, again, senses.frame);
                }
            }
            Step::Rest | Step::Over => {}
        }
    }

    fn begin(&mut self, step: Step, frame: u32) {
        (self.step, self.began) = (step, Some(frame));
        self.rows.clear();
    }

    /// Judges what needs no touch, on the second half of the rest: in the first the person may still move.
    fn judge_rest(&mut self) {
        let half = self.rows.len() / 2;
        self.rows.drain(..half);
        self.rest_mv = mean(&self.rows);
        self.noise_mv = std::array::from_fn(|n| self.most_mv(n));
        for &channel in &self.channels {
            let (at_mv, Channel { low_mv, high_mv, rest_mv, .. }) =
                (self.rest_mv[channel], &CHANNELS[channel]);
            let (_, [below, above]) = demands(self.roles[channel]);
            let stands = -below..=above;
            self.verdicts[channel] = if at_mv < f64::from(*low_mv).max(DEAD_MV) {
                Some(Verdict::Dead(at_mv))
            } else if at_mv > f64::from(*high_mv).min(SHORT_MV) {
                Some(Verdict::Shorted(at_mv))
            } else if self.noise_mv[channel] < 1e-6 {
                Some(Verdict::Stuck(at_mv))
            } else if channel != OPENING && !stands.contains(&(at_mv - f64::from(*rest_mv))) {
                // The hand's opening may stand anywhere.
                Some(Verdict::Off(at_mv))
            } else {
                (channel == MOTOR_CURRENT).then_some(Verdict::Pass(at_mv))
            };
        }
    }

    /// Asks for the channel in this place, or for the next that a touch can test.
    fn ask(&mut self, n: usize, again: bool, frame: u32) {
        let can_be_touched = |channel: &usize| {
            *channel != MOTOR_CURRENT
                && matches!(self.verdicts[*channel], None | Some(Verdict::Off(_) | Verdict::Moved(_)))
        };
        let Some(n) = (n..self.channels.len()).find(|&n| can_be_touched(&self.channels[n])) else {
            self.begin(Step::Over, frame);
            self.compare();
            self.said.extend(self.summary());
            return;
        };
        self.begin(Step::Asked(n, again, None), frame);
        self.said.push(self.asks(n, again));
    }

    fn asks(&self, n: usize, again: bool) -> String {
        let channel = self.channels[n];
        let (name, of) = (CHANNELS[channel].name, self.channels.len());
        let hint = match channel {
            OPENING => ": turn the fingers' axle",
            _ if self.roles[channel] == Role::Muscle => ", and relax",
            _ => "",
        };
        let again = if again { ", once more" } else { "" };
        format!("{} {name}{hint}{again} ({}; {} of {of})", self.roles[channel].verb(), input(channel), n + 1)
    }

    /// Corrects one side of exchanged wires by the other: a channel that passed, or was not asked for, was not exchanged.
    fn compare(&mut self) {
        for channel in 0..COUNT {
            let Some(Verdict::Moved(other)) = self.verdicts[channel] else { continue };
            if matches!(self.verdicts[other], Some(Verdict::Moved(_))) {
                continue;
            }
            let swapped = (0..COUNT).find(|&n| self.verdicts[n] == Some(Verdict::Moved(channel)));
            self.verdicts[channel] = Some(Verdict::Moved(swapped.unwrap_or(other)));
        }
    }

    /// Distance of a channel from its rest; from 1 on it is a move.
    fn moved(&self, row: &Row, channel: usize) -> f64 {
        let (least_mv, _) = demands(self.roles[channel]);
        let part = |n: usize| {
            let off_mv = (row[n] - self.rest_mv[n]).abs();
            off_mv / least_mv.max(OVER_NOISE * self.noise_mv[n])
        };
        let envelope = if channel < PVDF + PVDF_COUNT { part(COUNT + channel) } else { 0.0 };
        part(channel).max(envelope)
    }

    fn moves(&self, row: &Row) -> bool {
        (0..COUNT).any(|channel| self.moved(row, channel) >= 1.0)
    }

    fn touched(&mut self, n: usize, again: bool, frame: u32) {
        let asked = self.channels[n];
        let peak = |channel: usize| self.rows.iter().map(|row| self.moved(row, channel)).fold(0.0, f64::max);
        let peaks: [f64; COUNT] = std::array::from_fn(peak);
        let role = self.roles[asked];
        let stands_off = matches!(self.verdicts[asked], Some(Verdict::Off(_)));
        // A muscle moves the hand: that is no wrong wire.
        let may_be_it = |n: usize| stands_off || role != Role::Muscle || self.roles[n] != Role::Hand;
        let loudest = |all: &dyn Fn(usize) -> bool| {
            (0..COUNT).filter(|&n| all(n)).max_by(|&a, &b| peaks[a].total_cmp(&peaks[b])).unwrap_or(asked)
        };
        let (of_kind, of_all) = (loudest(&|n| self.roles[n] == role), loudest(&may_be_it));
        let bridged = (0..COUNT).find(|&other| {
            let loud = ALIKE_LOUD * peaks[of_kind].max(1.0);
            other != asked && peaks[asked].min(peaks[other]) >= loud && self.is_bridged(asked, other)
        });
        // Sensors of one kind pick up a little of each other, and a press moves other kinds, too.
        let other = if peaks[of_kind] >= BROTHERS * peaks[of_all] { of_kind } else { of_all };
        let verdict = match bridged {
            Some(other) => Verdict::Bridged(other),
            None if peaks[asked] >= 1.0 && of_kind == asked => Verdict::Pass(self.most_mv(asked)),
            None if peaks[other] >= 1.0 => Verdict::Moved(other),
            None => Verdict::Silent,
        };
        // The wrong sensor may have been touched.
        let repeats = matches!(verdict, Verdict::Moved(_)) && !again;
        // A verdict from before outweighs silence.
        match verdict {
            Verdict::Silent if again => {}
            Verdict::Silent | Verdict::Pass(_) if stands_off => {}
            _ => self.verdicts[asked] = Some(verdict),
        }
        self.said.push(match verdict {
            Verdict::Pass(_) if stands_off => "   moves".to_owned(),
            Verdict::Pass(mv) => format!("   pass, {mv:.0} mV"),
            other => format!("   FAIL: {}", other.words(asked)),
        });
        self.begin(Step::Stills(if repeats { n } else { n + 1 }, repeats), frame);
    }

    /// Largest distance of a channel from its rest, mV.
    fn most_mv(&self, n: usize) -> f64 {
        self.rows.iter().map(|row| (row[n] - self.rest_mv[n]).abs()).fold(0.0, f64::max)
    }

    /// Whether two channels read the same all the time, at rest and now.
    fn is_bridged(&self, asked: usize, other: usize) -> bool {
        let (rest, mut moved, mut apart) = (self.rest_mv[asked], 0.0, 0.0);
        let (least_mv, _) = demands(self.roles[asked]);
        for row in self.rows.iter().filter(|row| (row[asked] - rest).abs() > least_mv / 2.0) {
            moved += (row[asked] - rest).abs();
            apart += (row[asked] - row[other]).abs();
        }
        let mut row = self.rest_mv;
        row[other] = rest;
        moved > 0.0 && apart < ALIKE * moved && self.moved(&row, other) < 1.0
    }

    fn summary(&self) -> Vec<String> {
        let mut lines = vec![String::new()];
        let passes = |channel: usize| matches!(self.verdicts[channel], Some(Verdict::Pass(_)));
        for &channel in self.channels.iter().filter(|&&channel| !passes(channel)) {
            let wire_name = wire(channel);
            lines.push(match self.verdicts[channel] {
                None => format!("{wire_name}: left out, not tested"),
                // The other side has been named.
                Some(Verdict::Moved(other))
                    if other < channel && self.verdicts[other] == Some(Verdict::Moved(channel)) =>
                {
                    continue;
                }
                Some(Verdict::Moved(other)) => {
                    format!("{wire_name} and {}: exchange their wires", wire(other))
                }
                Some(verdict) => format!("{wire_name}: {}", verdict.words(channel)),
            });
        }
        let passed = self.channels.iter().filter(|&&channel| passes(channel)).count();
        lines.push(format!("{passed} of {} channels pass", self.channels.len()));
        lines
    }

    pub fn passes(&self) -> bool {
        self.channels.iter().all(|&channel| matches!(self.verdicts[channel], Some(Verdict::Pass(_))))
    }
}

/// The channels of these names or prefixes; without any, all. Fails on a word that fits none.
fn named(words: &[String]) -> anyhow::Result<Vec<usize>> {
    let fits = |n: usize, word: &String| match by_name(word) {
        Some(only) => n == only,
        None => CHANNELS[n].name.starts_with(word.as_str()),
    };
    if let Some(word) = words.iter().find(|word| !(0..COUNT).any(|n| fits(n, word))) {
        bail!("no channel begins with `{word}`: `tenax tables wiring` has them");
    }
    Ok((0..COUNT).filter(|&n| words.is_empty() || words.iter().any(|word| fits(n, word))).collect())
}
