//! Calibration of the head's curve: known weights on a balance, one after the other.

use serde::Serialize;
use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, mv_from_sample, sample_from_mv};
use tenax_logic::photoelastic::HeadConfig;
use tenax_logic::photoelastic::curve::{Curve, HALF_TURN, KNOTS, phase_of};
use tenax_logic::photoelastic::split::Q;
use tenax_scene::Seeds;
use tenax_scene::sensor::photoelastic::curve::{Day, Making, receiver_mv};
use tenax_scene::sensor::photoelastic::optics::Layer;

use super::bench::{Bench, mean_head};
use crate::equations::Equations;

/// A gram, N.
const GRAM_N: f64 = 9.806_65e-3;
/// Grams from one weight to the next, up to the first of them, and beyond.
const FINE: (f64, f64) = (20.0, 2.0);
const STEP: f64 = 10.0;
/// The ac part of slip is so many times the largest that was read while nothing slipped.
const SLIP_TIMES: i32 = 2;
const CYCLES: usize = 40;

/// One weight, and what was read under it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Weighed {
    pub force_n: f64,
    /// Voltage at the pin, mV.
    pub level_mv: f64,
    /// Reading by the calibrated curve, N.
    pub read_n: f64,
}

/// A calibration, and how well it fits.
#[derive(Clone, Debug)]
pub struct Calibration {
    pub curve: Curve,
    /// Every weight up to the curve's end.
    pub weighed: Vec<Weighed>,
    /// The mean size of the ac part that means slip, mV, where the ac part was read as well.
    pub slip_mv: Option<u16>,
}

impl Calibration {
    /// The configuration of a head with this calibration.
    pub fn config(&self) -> HeadConfig {
        let mean = mean_head();
        let slip = self.slip_mv.map_or(mean.slip, |mv| sample_from_mv(mv.into()));
        HeadConfig { curve: self.curve, slip, ..mean }
    }

    /// The largest residual, % of the curve's end.
    pub fn worst_percent(&self) -> f64 {
        let end_n = f64::from(self.curve.force_mn[KNOTS - 1]) / 1e3;
        self.weighed.iter().map(|w| (w.read_n - w.force_n).abs() / end_n * 100.0).fold(0.0, f64::max)
    }
}

/// Puts weight after weight on a head, up to 20 % beyond where its curve should end.
pub fn weigh(making: &Making, day: &Day, seeds: Seeds) -> Calibration {
    let mut bench = Bench::new(mean_head(), seeds.noise);
    let mut loudest = 0;
    let mut read = |force_n: f64, bench: &mut Bench| {
        let mut sum = 0.0;
        let mut pin_v = |t_s: f64| receiver_mv(&Layer::DUBEY, making, day, t_s, force_n, 0.0) / 1e3;
        let frames = CYCLES * usize::from(FRAMES_PER_SLOW_FRAME);
        for frame in 0..frames {
            sum += f64::from(bench.frame(&mut pin_v));
            // Each weight is put on with a jerk.
            if frame > frames / 2 {
                loudest = loudest.max(bench.head.split.envelope);
            }
        }
        sum / frames as f64 * 16.0
    };
    let fine = (FINE.0 / FINE.1) as usize;
    let coarse = ((1.2 * making.back_n / GRAM_N - FINE.0) / STEP) as usize;
    let grams = (0..fine).map(|n| n as f64 * FINE.1).chain((0..coarse).map(|n| FINE.0 + n as f64 * STEP));
    let forces = grams.map(|grams| grams * GRAM_N);
    let levels: Vec<_> = forces.map(|force_n| (force_n, read(force_n, &mut bench))).collect();
    let slip_mv = mv_from_sample(((SLIP_TIMES * loudest) >> Q) as u16).max(1) as u16;
    Calibration { slip_mv: Some(slip_mv), ..fit(&levels) }
}

/// The curve through forces and levels (1/16 of a sample), in rising order of force, the first without load.
pub fn fit(levels: &[(f64, f64)]) -> Calibration {
    let dark = levels.first().map_or(0.0, |first| first.1);
    let top = (1..levels.len() - 1).max_by(|a, b| levels[*a].1.total_cmp(&levels[*b].1)).unwrap_or(1);
    let bright = summit(&levels[top - 1..=top + 1]);
    // Where the light is back at its first value the curve ends, or at the lowest if noise or frozen birefringence keep it
    // from that.
    let back = (top..levels.len()).find(|n| levels[*n].1 <= dark + 5e-4 * (bright - dark));
    let lowest = (top..levels.len()).min_by(|a, b| levels[*a].1.total_cmp(&levels[*b].1));
    let end = back.or(lowest).unwrap_or(top);
    let mut curve =
        Curve { dark_q4: dark.round() as i32, bright_q4: bright.round() as i32, force_mn: [0; KNOTS] };
    let phases: Vec<(f64, f64)> = levels[..=end]
        .iter()
        .enumerate()
        .map(|(n, (force_n, level))| {
            let phase = phase_of(curve.part(level.round() as i32));
            (f64::from(if n < top { phase } else { HALF_TURN - phase }), *force_n)
        })
        .collect();
    // The brightest itself may lie on either side.
    let sure: Vec<_> = [&phases[..top], &phases[top + 1..]].concat();
    for (knot, force_n) in curve.force_mn.iter_mut().zip(knots(&sure)) {
        *knot = (force_n * 1e3).round() as i32;
    }
    let weighed = levels[..=end].iter().zip(&phases).map(|((force_n, level), (phase, _))| Weighed {
        force_n: *force_n,
        level_mv: level / 16.0 * 3_300.0 / 16_380.0,
        read_n: [*phase as i32, HALF_TURN - *phase as i32]
            .map(|phase| f64::from(curve.force_mn(phase)) / 1e3)
            .into_iter()
            .min_by(|a, b| (a - force_n).abs().total_cmp(&(b - force_n).abs()))
            .unwrap_or(0.0),
    });
    Calibration { curve, weighed: weighed.collect(), slip_mv: None }
}

/// The top of the parabola through three levels at even distances.
fn summit(three: &[(f64, f64)]) -> f64 {
    let [(_, a), (_, b), (_, c)] = *three else { return 0.0 };
    let bend = a - 2.0 * b + c;
    if bend < 0.0 { b - (c - a) * (c - a) / (8.0 * bend) } else { b }
}

/// The forces at the knots: of each, the parabola through the points up to one knot around it (least squares).
fn knots(phases: &[(f64, f64)]) -> [f64; KNOTS] {
    let step = f64::from(HALF_TURN) / KNOTS as f64;
    std::array::from_fn(|n| {
        let knot = (n + 1) as f64 * step;
        let mut fit = Equations::new(3);
        for (phase, force_n) in phases {
            let off = (phase - knot) / step;
            // Where the light hardly changes, its noise is a large phase: at the peak and at the ends.
            let sure = (std::f64::consts::TAU * phase / f64::from(HALF_TURN)).sin().powi(2) + 0.01;
            let weight = sure * (1.0 - off * off).max(0.0);
            fit.add(&[1.0, off, off * off], weight, weight * force_n);
        }
        fit.solve()[0]
    })
}
