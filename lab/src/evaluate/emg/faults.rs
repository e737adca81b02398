//! Faults of the electrodes drawn over recorded people who hold something, rest, and at the end open the hand: by how much each fault opens
//! and closes it, whether it is reported, and whether it hinders the opening. A rest that moves the hand by itself is drawn again: that is a
//! false motion, which is counted elsewhere.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::ops::Range;

use clap::ValueEnum;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use serde::Serialize;
use tenax_hal_shim::motor::MotorDrive;
use tenax_logic::account::Account;
use tenax_logic::config::Config;
use tenax_logic::emg::Emg;
use tenax_logic::emg::constants::Fitted;
use tenax_logic::emg::decide::{Decide, Wish};
use tenax_logic::emg::level::uv_of;
use tenax_logic::emg::model::EmgModel;
use tenax_logic::emg::settings::GateConfig;
use tenax_logic::emg::trust::Quality;
use tenax_logic::gate::Gate;

use super::recordings::{HZ, OPEN, PAIRS_HZ};
use super::trial::{Kind, Trial};

/// Safe opening by a fault while something is held, mm of the scenes' hand, 120 mm/s at full duty (docs/emg.md).
const SAFE_MM: f64 = 0.75;
/// Before the fault, s; how long a fault lasts; and what follows.
const BEFORE_S: f64 = 8.0;
const LASTS_S: [f64; 2] = [0.1, 30.0];
const AFTER_S: f64 = 1.0;
/// Within which a fault is reported that lasts as long and is activity, s.
const REPORTED_S: f64 = 3.0;
/// Longest closing in all by a restless electrode, and time within which it is reported whatever its level, s.
const SAFE_CLOSED_S: f64 = 0.3;
const TOLD_S: f64 = 5.0;
/// Delay of an opening beside a fault, s, and the part of its duration that it keeps.
const LATE_S: f64 = 0.06;
const KEPT_PART: f64 = 0.8;
/// A restless electrode: share of its calibrated contraction, ripple, its frequency, Hz, and duration, s; one in 64 lasts up to an hour.
const RESTLESS_SHARE: Range<f64> = 0.3..1.0;
const RESTLESS_RIPPLE: Range<f64> = 0.0..0.1;
const RESTLESS_HZ: [f64; 2] = [0.05, 5.0];
const RESTLESS_S: [f64; 3] = [1.0, 60.0, 3_600.0];
/// Time in which it reaches its level, s; shorter ones are a jump.
const RESTLESS_RISE_S: [f64; 2] = [0.03, 3.0];
/// Time constant of a front end, s.
const FRONT_END_S: f64 = 0.027;
/// Pins that give a number, mV above the live zero.
const RANGE_MV: [f64; 2] = [-200.0, 2_950.0];

/// Signal of an electrode instead of its muscle's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Fault {
    /// Off the skin: mains, rectified and smoothed.
    Lifted,
    Loose,
    Creeping,
    /// Hum beside the muscle.
    Humming,
    /// Hum that swings with the arm, 0.8 to 2.2 times a second.
    Swinging,
    /// At the top of its range.
    Saturated,
    /// A voltage, at once.
    Broken,
    /// At a part of its contraction, wandering about it, and never at rest.
    Restless,
}

#[derive(Clone, Copy, Debug)]
struct Drawn {
    fault: Fault,
    /// Whether the closing and the opening electrode have it.
    has: [bool; 2],
    /// mV above the live zero, or mV a second.
    mv: [f64; 2],
    ripple: f64,
    hz: f64,
    lasts_s: f64,
    wanders: [Wander; 2],
    /// Part of its signal that a loose contact gives now, and until when, s.
    loose: [(f64, f64); 2],
    state: [f64; 2],
}

/// A restless electrode's own: what it does owes nothing to the other one.
#[derive(Clone, Copy, Debug, Default)]
struct Wander {
    wave: f64,
    noise: f64,
    hz: f64,
    turn: f64,
    rise_s: f64,
}

impl Drawn {
    /// `calibrated`: levels of rest and of the own contraction, by site.
    fn of(rng: &mut ChaCha8Rng, calibrated: [[i32; 2]; 2]) -> Self {
        let fault = Fault::value_variants()[rng.random_range(0..Fault::value_variants().len())];
        let has = [[true, false], [false, true], [false, true], [true; 2]][rng.random_range(0..4)];
        let level =
            |rng: &mut ChaCha8Rng, low: f64, high: f64| low * (high / low).powf(rng.random_range(0.0..1.0));
        let mv = match fault {
            Fault::Lifted | Fault::Swinging => level(rng, 100.0, 2_800.0),
            Fault::Loose => level(rng, 100.0, 2_000.0),
            Fault::Creeping => level(rng, 30.0, 30_000.0),
            Fault::Humming => level(rng, 50.0, 1_500.0),
            Fault::Saturated => level(rng, 2_850.0, 3_000.0),
            Fault::Broken => level(rng, 1.0, 3_301.0) - 301.0,
            Fault::Restless => 0.0,
        };
        let lasts_s = match fault {
            Fault::Restless => {
                let longest_s = RESTLESS_S[1 + usize::from(rng.random_ratio(1, 64))];
                level(rng, RESTLESS_S[0], longest_s)
            }
            _ => level(rng, LASTS_S[0], LASTS_S[1]),
        };
        let other = if has == [true; 2] { rng.random_range(0.05..1.0) } else { 1.0 };
        let mv = if rng.random_bool(0.5) { [mv, mv * other] } else { [mv * other, mv] };
        let own = Self {
            fault,
            has,
            mv,
            ripple: rng.random_range(0.0..0.3),
            hz: rng.random_range(0.8..2.2),
            lasts_s,
            wanders: Default::default(),
            loose: Default::default(),
            state: [f64::NAN; 2],
        };
        if fault != Fault::Restless {
            return own;
        }
        let stands = |[rest, contracts]: [i32; 2], share: f64| {
            f64::from(uv_of(rest + (f64::from(contracts - rest) * share) as i32)) / 1e3
        };
        let wander = |_| {
            let (ripple, part) = (rng.random_range(RESTLESS_RIPPLE), rng.random_range(0.0..1.0));
            Wander {
                wave: ripple * part,
                noise: ripple * (1.0 - part),
                hz: level(rng, RESTLESS_HZ[0], RESTLESS_HZ[1]),
                turn: rng.random_range(0.0..TAU),
                rise_s: level(rng, RESTLESS_RISE_S[0], RESTLESS_RISE_S[1]),
            }
        };
        let wanders = [0, 1].map(wander);
        Self { mv: calibrated.map(|levels| stands(levels, rng.random_range(RESTLESS_SHARE))), wanders, ..own }
    }

    /// Signal of a site's electrode `t_s` after the fault began, mV.
    fn read(&mut self, site: usize, muscle_mv: f64, t_s: f64, rng: &mut ChaCha8Rng) -> f64 {
        if !self.has[site] {
            return muscle_mv;
        }
        if t_s >= self.loose[site].1 {
            self.loose[site] = (rng.random_range(0.0..1.0), t_s + rng.random_range(0.02..0.3));
        }
        let mv = self.mv[site];
        let swing = 0.5 - 0.5 * (TAU * self.hz * t_s).cos();
        let target = match self.fault {
            Fault::Lifted => mv,
            Fault::Loose => mv * self.loose[site].0,
            Fault::Humming => muscle_mv + mv,
            Fault::Swinging => muscle_mv + mv * swing,
            Fault::Creeping => return (muscle_mv + mv * t_s).min(3_000.0),
            Fault::Saturated | Fault::Broken => return mv,
            Fault::Restless => {
                let Wander { wave, noise, hz, turn, rise_s } = self.wanders[site];
                let wave = wave * (TAU * hz * t_s + turn).sin();
                // Anew as often as a loose contact.
                let noise = noise * (2.0 * self.loose[site].0 - 1.0);
                let risen = (t_s / rise_s).min(1.0);
                muscle_mv.min(mv) * (1.0 - risen) + mv * (risen + wave + noise)
            }
        };
        if self.state[site].is_nan() {
            self.state[site] = muscle_mv;
        }
        self.state[site] += (1.0 - (-1.0 / PAIRS_HZ / FRONT_END_S).exp()) * (target - self.state[site]);
        if self.fault == Fault::Restless {
            return self.state[site];
        }
        // What the low-pass leaves of twice the mains.
        let ripple = mv * self.ripple / (TAU * 100.0 * FRONT_END_S).hypot(1.0);
        self.state[site] + ripple * (TAU * 100.0 * t_s).sin()
    }
}

#[derive(Clone, Copy, Debug)]
struct Outcome {
    fault: Fault,
    both: bool,
    wearer: usize,
    opened_mm: f64,
    closed_s: f64,
    /// Whether it lasts and is activity, and whether it was reported in time.
    lasting: bool,
    reported: bool,
    /// A restless electrode that is not reported within [`TOLD_S`].
    untold: bool,
    beside: Option<Beside>,
}

/// An opening with a fault of the closing electrode alone: whether it began late, ended early, and stayed slow.
#[derive(Clone, Copy, Debug)]
struct Beside {
    late: bool,
    ended: bool,
    slow: bool,
}

#[derive(Clone)]
struct Hand {
    emg: Emg,
    gate: Gate,
    account: Account,
    config: GateConfig,
    pairs: u32,
    opened_mm: f64,
    closed_s: f64,
}

impl Hand {
    fn new(emg: Emg) -> Self {
        Self {
            emg,
            gate: Gate::default(),
            account: Account::default(),
            config: Config::default().gate,
            pairs: 0,
            opened_mm: 0.0,
            closed_s: 0.0,
        }
    }

    fn take(&mut self, uv: [Option<i32>; 2]) {
        self.gate.take(self.emg.take(uv));
        self.pairs += 1;
        // 25 frames in three pairs.
        for _ in 0..if self.pairs.is_multiple_of(3) { 9 } else { 8 } {
            self.gate.tick(&self.config, false);
            let wish = self.gate.wish(&self.config, &self.account);
            self.account.step(&self.gate, wish, true);
            match wish {
                MotorDrive::Open(duty) => {
                    self.opened_mm += f64::from(duty.as_per_mille()) / 1_000.0 * 120.0 / 2_000.0;
                }
                MotorDrive::Close(_) => self.closed_s += 1.0 / 2_000.0,
                MotorDrive::Coast => {}
            }
        }
    }

    /// Pairs until the first with a wish to open, the number of such pairs, and the opening, mm.
    fn opens(mut self, pairs: impl Iterator<Item = [Option<i32>; 2]>) -> Option<(usize, usize, f64)> {
        let (before_mm, mut first, mut count) = (self.opened_mm, None, 0);
        for (n, uv) in pairs.enumerate() {
            self.take(uv);
            if self.gate.verdict().wish == Wish::Open {
                first = first.or(Some(n));
                count += 1;
            }
        }
        first.map(|first| (first, count, self.opened_mm - before_mm))
    }
}

/// Kinds of wearers: calibrated as each kind of trial is, or not at all.
const WEARERS: [&str; 4] = ["same session", "other posture", "first day kept", "not calibrated"];

/// A case: none where there is no rest, or it moves the hand by itself.
fn case(fitted: &'static Fitted, trial: &Trial, wearer: usize, rng: &mut ChaCha8Rng) -> Option<Outcome> {
    let rests: Vec<_> = trial.recording.rests().into_iter().filter(|rows| rows.len() > 100).collect();
    let rest = rests.get(rng.random_range(0..rests.len().max(1)))?.clone();
    let model = (wearer + 1 < WEARERS.len()).then_some(&trial.model);
    // Without a calibration the extensor's opens.
    let opens = model.map_or(1, EmgModel::opening_site);
    let electrodes = [1 - opens, opens];
    let calibrated = electrodes.map(|n| {
        let own = if n == trial.model.opening_site() { trial.model.open() } else { trial.model.close() };
        [trial.model.rest()[n], own[n]]
    });
    let mut drawn = Drawn::of(rng, calibrated);
    let mut hand = Hand::new(Emg::of(Decide::with(fitted, model)));
    let begin = rest.start.saturating_sub((BEFORE_S * HZ) as usize);
    let pairs = |rows: Range<usize>| trial.recording.pairs(rows, trial.sites).into_iter().map(|(_, uv)| uv);
    for uv in pairs(begin..rng.random_range(rest.start + 50..rest.end)) {
        hand.take(uv.map(Some));
    }
    let resting: Vec<[i32; 2]> = pairs(rest).collect();
    // There and back: no jump where it begins again.
    let resting = resting.iter().chain(resting.iter().rev()).cycle();
    (hand.opened_mm, hand.closed_s) = (0.0, 0.0);
    let mut alone = hand.clone();
    let mut active = [0; 2];
    let [mut lasting, mut reported] = [false; 2];
    let mut told_s = f64::INFINITY;
    let mut beside = None;
    let reported_within = (REPORTED_S * PAIRS_HZ) as u32;
    let (fault, has, lasts_s) = (drawn.fault, drawn.has, drawn.lasts_s);
    let lasts = (lasts_s * PAIRS_HZ) as u32;
    let read = |drawn: &mut Drawn, uv: [i32; 2], t_s: f64, rng: &mut ChaCha8Rng| {
        let mut pair = uv.map(Some);
        for (site, electrode) in electrodes.into_iter().enumerate() {
            let mv = drawn.read(site, f64::from(uv[electrode]) / 1e3, t_s, rng);
            pair[electrode] = (RANGE_MV[0]..RANGE_MV[1]).contains(&mv).then_some((mv * 1e3) as i32);
        }
        pair
    };
    for (n, uv) in (0..lasts + (AFTER_S * PAIRS_HZ) as u32).zip(resting) {
        let t_s = f64::from(n) / PAIRS_HZ;
        if n == lasts && has == [true, false] {
            let opening = trial.recording.contractions(OPEN);
            let opening = opening.get(rng.random_range(0..opening.len().max(1)))?.clone();
            let opening: Vec<[i32; 2]> = pairs(opening.start.saturating_sub(20)..opening.end).collect();
            let faulty: Vec<_> = (n..)
                .zip(&opening)
                .map(|(n, uv)| read(&mut drawn, *uv, f64::from(n) / PAIRS_HZ, rng))
                .collect();
            beside = alone.clone().opens(opening.iter().map(|uv| uv.map(Some))).map(|(first, count, mm)| {
                let (begun, kept, moved) =
                    hand.clone().opens(faulty.into_iter()).unwrap_or((usize::MAX, 0, 0.0));
                Beside {
                    late: begun as f64 > first as f64 + LATE_S * PAIRS_HZ,
                    ended: (kept as f64) < KEPT_PART * count as f64,
                    slow: moved < 0.5 * mm,
                }
            });
        }
        alone.take(uv.map(Some));
        if n >= lasts {
            hand.take(uv.map(Some));
            continue;
        }
        let pair = read(&mut drawn, *uv, t_s, rng);
        hand.take(pair);
        for (_, electrode) in electrodes.into_iter().enumerate().filter(|&(site, _)| has[site]) {
            let is_told = hand.emg.quality(electrode) != Quality::Good;
            if is_told {
                told_s = told_s.min(t_s);
            }
            if pair[electrode].is_none() || hand.emg.is_raised(electrode) {
                active[electrode] += 1;
                lasting |= active[electrode] >= reported_within;
                reported |= active[electrode] <= reported_within && is_told;
            }
        }
    }
    let active_s = f64::from(active[0].max(active[1])) / PAIRS_HZ;
    (alone.opened_mm == 0.0 && alone.closed_s == 0.0).then_some(Outcome {
        fault,
        both: has == [true; 2],
        wearer,
        opened_mm: hand.opened_mm,
        closed_s: hand.closed_s,
        lasting,
        reported,
        untold: fault == Fault::Restless && active_s > TOLD_S && told_s > TOLD_S,
        beside,
    })
}

#[derive(Clone, Debug, Default, Serialize)]
pub struct Row {
    pub cases: usize,
    /// Those that opened by more than is safe, and the most that one did, mm.
    pub dropped: usize,
    pub most_mm: f64,
    /// Those that closed for longer than is safe in all, and the longest, s.
    pub closed: usize,
    pub most_closed_s: f64,
    pub lasting: usize,
    pub reported: usize,
    /// Restless electrodes that were not reported in time.
    pub untold: usize,
    /// Openings beside a fault of the closing electrode; of them late, ended early, and slow.
    pub openings: usize,
    pub late: usize,
    pub ended: usize,
    pub slow: usize,
}

impl Row {
    fn of<'a>(outcomes: impl Iterator<Item = &'a Outcome>) -> Self {
        let mut row = Self::default();
        for own in outcomes {
            row.cases += 1;
            row.dropped += usize::from(own.opened_mm > SAFE_MM);
            row.most_mm = row.most_mm.max(own.opened_mm);
            row.closed += usize::from(own.closed_s > SAFE_CLOSED_S);
            row.most_closed_s = row.most_closed_s.max(own.closed_s);
            row.lasting += usize::from(own.lasting);
            row.reported += usize::from(own.lasting && own.reported);
            row.untold += usize::from(own.untold);
            if let Some(Beside { late, ended, slow }) = own.beside {
                row.openings += 1;
                row.late += usize::from(late);
                row.ended += usize::from(ended);
                row.slow += usize::from(slow);
            }
        }
        row
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub seed: u64,
    pub all: Row,
    /// Faults of one electrode, of both, and of one by kind.
    pub one: Row,
    pub both: Row,
    pub faults: BTreeMap<Fault, Row>,
    pub wearers: BTreeMap<&'static str, Row>,
}

pub(in crate::evaluate) fn draw(fitted: &'static Fitted, trials: &[&Trial], cases: u32, seed: u64) -> Report {
    let of_kind = |wearer: usize| -> Vec<&&Trial> {
        let kinds = [Kind::SameSession, Kind::OtherPosture, Kind::FirstDayKept];
        trials.iter().filter(|trial| kinds.get(wearer).is_none_or(|kind| *kind == trial.kind)).collect()
    };
    let by_wearer = [0, 1, 2, 3].map(of_kind);
    let outcomes: Vec<Outcome> = (0..cases)
        .into_par_iter()
        .filter_map(|number| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed << 32 | u64::from(number));
            let wearer = number as usize % WEARERS.len();
            let own = &by_wearer[wearer];
            // A folder may have no trial of a kind; and a person who never rests would not end it.
            (0..50).find_map(|_| {
                let trial = own.get(rng.random_range(0..own.len().max(1)))?;
                case(fitted, trial, wearer, &mut rng)
            })
        })
        .collect();
    let one = || outcomes.iter().filter(|own| !own.both);
    let of_wearer = |wearer| Row::of(outcomes.iter().filter(|own| own.wearer == wearer));
    let of_fault = |fault| Row::of(one().filter(|own| own.fault == fault));
    Report {
        seed,
        all: Row::of(outcomes.iter()),
        one: Row::of(one()),
        both: Row::of(outcomes.iter().filter(|own| own.both)),
        faults: Fault::value_variants().iter().map(|&fault| (fault, of_fault(fault))).collect(),
        wearers: WEARERS.into_iter().enumerate().map(|(n, name)| (name, of_wearer(n))).collect(),
    }
}
