//! Speed and accuracy for the wearer at each rate of false motions: the hand, and plain control as in `baseline.py` of the data set, a
//! threshold on the site, the side by the ratio of both electrodes. Both ask for more or less of the calibrated contraction.

use std::path::Path;

use rayon::prelude::*;
use tenax_logic::emg::constants::Fitted;
use tenax_logic::emg::decide::Wish;
use tenax_logic::emg::fitted::FITTED;
use tenax_logic::emg::level::level_of;

use super::Recordings;
use super::score::{Count, Said, Score};
use super::trial::{Kind, Trial, Trials};

/// Parts of the calibrated rise that plain control asks for, and rows for which it waits.
const PLAIN: [f64; 9] = [0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];
const PLAIN_DWELL: usize = 3;
/// Demands of the hand, times those that ship.
const HAND: [f64; 9] = [0.5, 0.65, 0.8, 0.9, 1.0, 1.1, 1.25, 1.4, 1.6];

#[derive(Clone, Debug)]
pub struct Point {
    /// `hand` or `plain`.
    pub control: &'static str,
    pub calibration: &'static str,
    /// Demand: a part of the calibrated rise, or times the shipped one.
    pub asks: f64,
    pub score: Score,
}

impl Point {
    /// Mean of the windows right of closing and opening.
    pub fn right(&self) -> f64 {
        f64::midpoint(self.score.close_right, self.score.open_right)
    }

    pub fn ships(&self) -> bool {
        self.control == "hand" && self.asks == 1.0
    }
}

/// Plain control, calibrated from what the hand was calibrated from. A rise is at least half an octave above nearly all of rest.
fn plain(trial: &Trial, part: f64) -> Vec<Said> {
    let model = &trial.model;
    let (closes, opens) = (model.closing_site(), model.opening_site());
    let (rest, close, open) = (model.rest(), model.close(), model.open());
    let begins = |site: usize, most: i32| {
        let own = f64::from(rest[site]);
        (own + part * (f64::from(most) - own)).max(own + 2.3 * f64::from(model.spread()[site]) + 512.0)
    };
    let begins = [begins(closes, close[closes]), begins(opens, open[opens])];
    let ratio = |point: [i32; 2]| f64::from(point[opens] - point[closes]);
    let middle = (ratio(close) + ratio(open)) / 2.0;
    let (mut last, mut stands, mut wish) = (Wish::Rest, 0, Wish::Rest);
    let said = |uv: [f64; 2]| {
        let [close, open] = uv.map(|uv| f64::from(level_of(uv as i32)));
        let wanted = match open - close > middle {
            true if open > begins[1] => Wish::Open,
            false if close > begins[0] => Wish::Close,
            _ => Wish::Rest,
        };
        stands = if wanted == last { stands + 1 } else { 1 };
        last = wanted;
        if stands >= PLAIN_DWELL {
            wish = wanted;
        }
        Said { wish, ..Said::default() }
    };
    trial.recording.site_uv([closes, opens].map(|n| trial.sites[n])).map(said).collect()
}

/// The shipped constants, asking for so much more or less of a contraction.
fn asking(times: f64) -> &'static Fitted {
    let scaled = |share: i32| (f64::from(share) * times).round() as i32;
    let mut fitted = FITTED.clone();
    fitted.begins = fitted.begins.map(scaled);
    fitted.ends = fitted.ends.map(scaled);
    // What asks for less of a contraction also averages and waits less.
    let less = |own: i32| (f64::from(own) * times.min(1.0).powi(2)).round() as i32;
    fitted.rise = less(fitted.rise);
    fitted.dwell = fitted.dwell.map(less);
    fitted.after_frames = fitted.after_frames.map(less);
    fitted.mean_frames = less(fitted.mean_frames).max(1);
    // A few for each curve.
    Box::leak(Box::new(fitted))
}

/// Both curves of everybody in a folder. Fails if there is nobody, or a recording cannot be read.
pub fn curves(folder: &Path) -> anyhow::Result<Vec<Point>> {
    let Recordings { people, .. } = Recordings::read(folder)?;
    let trials: Vec<Trial> = people.values().flat_map(|days| Trials::of(days).all).collect();
    let trials: Vec<_> = trials.into_par_iter().map(|trial| (trial.hear(), trial)).collect();
    let mut points = Vec::new();
    for (kind, calibration) in [(Kind::SameSession, "same session"), (Kind::OtherPosture, "other posture")] {
        let mut add = |control, asks, play: &dyn Fn(&Trial, &[_]) -> Vec<Said>| {
            let own = trials.iter().filter(|(_, trial)| trial.kind == kind);
            let counts: Vec<Count> = own.map(|(heard, trial)| trial.counted(&play(trial, heard))).collect();
            let score = Count::sum(&counts).score();
            points.extend(score.map(|score| Point { control, calibration, asks, score }));
        };
        PLAIN.iter().for_each(|&part| add("plain", part, &|trial, _| plain(trial, part)));
        for times in HAND {
            let fitted = asking(times);
            add("hand", times, &|trial, heard| trial.decide(fitted, heard));
        }
    }
    Ok(points)
}
