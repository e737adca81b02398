//! Faults of the electrodes drawn over recorded people who hold something and rest: by how much each opens the hand, and whether it is
//! reported. A rest that moves the hand by itself is drawn again: that is a false motion, which is counted elsewhere.

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
use tenax_logic::emg::decide::Decide;
use tenax_logic::emg::model::EmgModel;
use tenax_logic::emg::settings::GateConfig;
use tenax_logic::emg::trust::Quality;
use tenax_logic::gate::Gate;

use super::recordings::{HZ, PAIRS_HZ};
use super::trial::{Kind, Trial};

/// Safe opening by a fault while something is held, mm of the scenes' hand, 120 mm/s at full duty (docs/emg.md).
const SAFE_MM: f64 = 0.75;
/// Before the fault, s; how long a fault lasts; and what follows.
const BEFORE_S: f64 = 8.0;
const LASTS_S: [f64; 2] = [0.1, 30.0];
const AFTER_S: f64 = 1.0;
/// Within which a fault is reported that lasts as long and is activity, s.
const REPORTED_S: f64 = 3.0;
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
    /// mV that a loose contact gives now, and until when, s.
    loose: ([f64; 2], f64),
    state: [f64; 2],
}

impl Drawn {
    fn of(rng: &mut ChaCha8Rng) -> Self {
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
        };
        let lasts_s = level(rng, LASTS_S[0], LASTS_S[1]);
        let other = if has == [true; 2] { rng.random_range(0.05..1.0) } else { 1.0 };
        let mv = if rng.random_bool(0.5) { [mv, mv * other] } else { [mv * other, mv] };
        Self {
            fault,
            has,
            mv,
            ripple: rng.random_range(0.0..0.3),
            hz: rng.random_range(0.8..2.2),
            lasts_s,
            loose: ([0.0; 2], 0.0),
            state: [f64::NAN; 2],
        }
    }

    /// Signal of a site's electrode `t_s` after the fault began, mV.
    fn read(&mut self, site: usize, muscle_mv: f64, t_s: f64, rng: &mut ChaCha8Rng) -> f64 {
        if !self.has[site] {
            return muscle_mv;
        }
        if t_s >= self.loose.1 {
            self.loose = (
                [0, 1].map(|n: usize| self.mv[n] * rng.random_range(0.0..1.0)),
                t_s + rng.random_range(0.02..0.3),
            );
        }
        let mv = self.mv[site];
        let swing = 0.5 - 0.5 * (TAU * self.hz * t_s).cos();
        let target = match self.fault {
            Fault::Lifted => mv,
            Fault::Loose => self.loose.0[site],
            Fault::Humming => muscle_mv + mv,
            Fault::Swinging => muscle_mv + mv * swing,
            Fault::Creeping => return (muscle_mv + mv * t_s).min(3_000.0),
            Fault::Saturated | Fault::Broken => return mv,
        };
        if self.state[site].is_nan() {
            self.state[site] = muscle_mv;
        }
        self.state[site] += (1.0 - (-1.0 / PAIRS_HZ / FRONT_END_S).exp()) * (target - self.state[site]);
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
    /// Whether it lasts and is activity, and whether it was reported in time.
    lasting: bool,
    reported: bool,
}

#[derive(Clone)]
struct Hand {
    emg: Emg,
    gate: Gate,
    account: Account,
    config: GateConfig,
    pairs: u32,
    opened_mm: f64,
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
            if let MotorDrive::Open(duty) = wish {
                self.opened_mm += f64::from(duty.as_per_mille()) / 1_000.0 * 120.0 / 2_000.0;
            }
        }
    }
}

/// Kinds of wearers: calibrated as each kind of trial is, or not at all.
const WEARERS: [&str; 4] = ["same session", "other posture", "first day kept", "not calibrated"];

/// A case: none where there is no rest, or it moves the hand by itself.
fn case(fitted: &'static Fitted, trial: &Trial, wearer: usize, rng: &mut ChaCha8Rng) -> Option<Outcome> {
    let rests: Vec<_> = trial.recording.rests().into_iter().filter(|rows| rows.len() > 100).collect();
    let rest = rests.get(rng.random_range(0..rests.len().max(1)))?.clone();
    let mut drawn = Drawn::of(rng);
    let model = (wearer + 1 < WEARERS.len()).then_some(&trial.model);
    // Without a calibration the extensor's opens.
    let opens = model.map_or(1, EmgModel::opening_site);
    let electrodes = [1 - opens, opens];
    let mut hand = Hand::new(Emg::of(Decide::with(fitted, model)));
    let begin = rest.start.saturating_sub((BEFORE_S * HZ) as usize);
    let pairs = |rows: Range<usize>| trial.recording.pairs(rows, trial.sites).into_iter().map(|(_, uv)| uv);
    for uv in pairs(begin..rng.random_range(rest.start + 50..rest.end)) {
        hand.take(uv.map(Some));
    }
    let resting: Vec<[i32; 2]> = pairs(rest).collect();
    // There and back: no jump where it begins again.
    let resting = resting.iter().chain(resting.iter().rev()).cycle();
    hand.opened_mm = 0.0;
    let mut alone = hand.clone();
    let mut active = [0; 2];
    let [mut lasting, mut reported] = [false; 2];
    let reported_within = (REPORTED_S * PAIRS_HZ) as u32;
    for (n, uv) in (0..((drawn.lasts_s + AFTER_S) * PAIRS_HZ) as u32).zip(resting) {
        alone.take(uv.map(Some));
        let t_s = f64::from(n) / PAIRS_HZ;
        let is_on = t_s < drawn.lasts_s;
        let mut pair = uv.map(Some);
        for (site, electrode) in electrodes.into_iter().enumerate().filter(|_| is_on) {
            let mv = drawn.read(site, f64::from(uv[electrode]) / 1e3, t_s, rng);
            pair[electrode] = (RANGE_MV[0]..RANGE_MV[1]).contains(&mv).then_some((mv * 1e3) as i32);
        }
        hand.take(pair);
        for (site, electrode) in electrodes.into_iter().enumerate().filter(|_| is_on) {
            if drawn.has[site] && (pair[electrode].is_none() || hand.emg.is_raised(electrode)) {
                active[site] += 1;
                lasting |= active[site] >= reported_within;
                reported |= active[site] <= reported_within && hand.emg.quality(electrode) != Quality::Good;
            }
        }
    }
    (alone.opened_mm == 0.0).then_some(Outcome {
        fault: drawn.fault,
        both: drawn.has == [true; 2],
        wearer,
        opened_mm: hand.opened_mm,
        lasting,
        reported,
    })
}

#[derive(Clone, Debug, Default, Serialize)]
pub struct Row {
    pub cases: usize,
    /// Those that opened by more than is safe, and the most that one did, mm.
    pub dropped: usize,
    pub most_mm: f64,
    pub lasting: usize,
    pub reported: usize,
}

impl Row {
    fn of<'a>(outcomes: impl Iterator<Item = &'a Outcome>) -> Self {
        let mut row = Self::default();
        for own in outcomes {
            row.cases += 1;
            row.dropped += usize::from(own.opened_mm > SAFE_MM);
            row.most_mm = row.most_mm.max(own.opened_mm);
            row.lasting += usize::from(own.lasting);
            row.reported += usize::from(own.lasting && own.reported);
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
