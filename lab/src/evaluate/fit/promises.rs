//! The promises to the wearer, as a cost: short recordings of other people, and made-up muscles that contract together, open and burst.
//! The tests of `host-tests` hold the whole of it.

use rayon::prelude::*;
use tenax_logic::emg::constants::Fitted;
use tenax_logic::emg::decide::{Decide, Wish};
use tenax_logic::emg::model::EmgModel;
use tenax_logic::emg::{Emg, Verdict};

use crate::evaluate::emg::two_channel::Session;

const BROKEN: f64 = 20.0;
/// Pairs a second.
const HZ: f64 = 240.0;

pub(super) struct Promises<'a> {
    sessions: &'a [Session],
    wearers: Vec<(EmgModel, [[f64; 2]; 3])>,
}

/// Rest, closing and opening, mV: the scenes' wearer, and one each of the shared sessions, as in the tests of `host-tests`.
const WEARERS_MV: [[[f64; 2]; 3]; 4] = [
    [[50.0, 50.0], [900.0, 95.0], [80.0, 560.0]],
    [[50.0, 50.0], [450.0, 72.0], [87.0, 750.0]],
    [[61.0, 48.0], [445.0, 165.0], [156.0, 1_490.0]],
    [[65.0, 141.0], [289.0, 161.0], [94.0, 989.0]],
];

fn alive(mv: f64, t_s: f64, k: usize) -> f64 {
    let tau = std::f64::consts::TAU;
    let [slow, fast] = [[2.7, 5.3], [2.3, 4.9]][k];
    mv * (1.0 + 0.12 * (tau * slow * t_s).sin() + 0.1 * (tau * fast * t_s + 1.0).sin())
}

impl<'a> Promises<'a> {
    pub fn of(sessions: &'a [Session]) -> Self {
        let wearer = |mv: [[f64; 2]; 3]| {
            let [rest, close, open] = mv.map(|pair| pair.map(|mv| (1e3 * mv) as i32));
            Some((EmgModel::of_uv(rest, close, open).ok()?, mv))
        };
        Self { sessions, wearers: WEARERS_MV.into_iter().filter_map(wearer).collect() }
    }

    pub fn cost(&self, fitted: &'static Fitted) -> f64 {
        let muscles: f64 = self.wearers.iter().map(|(model, mv)| of_muscles(fitted, model, *mv)).sum();
        if muscles >= BROKEN {
            return muscles;
        }
        let costs = self.sessions.par_iter().map(|session| of_session(fitted, session));
        costs.sum::<f64>() + muscles
    }
}

/// At least 0.93 of the windows right, nothing that must not be, and no doubt.
fn of_session(fitted: &'static Fitted, session: &Session) -> f64 {
    let report = session.score(fitted);
    let wrong = report.wrong_ms.iter().map(|(name, &ms)| {
        let most = match name.as_str() {
            // `b_` begins them with an extension, the flexor at rest: an opening.
            "handflexion_dynamic" => 430,
            // Extended fingers are neither of the chosen contractions.
            name if name.starts_with("fingerextension") => 250,
            _ => 0,
        };
        f64::from(ms.saturating_sub(most)) / 100.0 * BROKEN
    });
    BROKEN * (0.93 - report.worst_right).max(0.0) * 10.0 + wrong.sum::<f64>() + report.doubts as f64 * BROKEN
}

/// Plays made-up envelopes: time, s, and electrode to mV.
fn play(
    fitted: &'static Fitted,
    model: &EmgModel,
    seconds: f64,
    muscle: impl Fn(f64, usize) -> f64,
) -> Vec<Verdict> {
    let mut emg = Emg::of(Decide::with(fitted, Some(model)));
    let uv = |t_s: f64, n: usize| Some((muscle(t_s, n).clamp(-300.0, 2_900.0) * 1e3) as i32);
    let times = (0..(seconds * HZ) as u32).map(|n| f64::from(n) / HZ);
    times.map(|t_s| emg.take([uv(t_s, 0), uv(t_s, 1)])).collect()
}

fn of_muscles(fitted: &'static Fitted, model: &EmgModel, [rest, close, open]: [[f64; 2]; 3]) -> f64 {
    let resting = |t: f64, n: usize| rest[n] * (1.0 + 0.05 * ((3.0 - n as f64) * t * 6.0).sin());
    let lasts_s =
        |said: &[Verdict], wish: Wish| said.iter().filter(|own| own.wish == wish).count() as f64 / HZ;
    let mut cost = 0.0;
    // Both muscles at once ask for nothing.
    for mv in [300.0, 500.0, 800.0, 1_500.0] {
        let muscle = |t: f64, n: usize| if t < 1.0 { resting(t, n) } else { alive(mv, t, n) };
        cost += lasts_s(&play(fitted, model, 3.0, muscle), Wish::Open) * BROKEN;
    }
    // An opening of a quarter above the calibrated one is answered at once, whatever the flexor is thought of.
    for rise_s in [0.03, 0.15, 0.3] {
        let said = play(fitted, model, 3.0, |t, n| {
            let up = ((t - 1.0) / rise_s).clamp(0.0, 1.0);
            resting(t, n) + up * ([1.0, 1.5][n] * open[n] - rest[n]) * alive(1.0, t, n).clamp(0.9, 1.2)
        });
        let supported = (1.0 + rise_s) * HZ;
        let opened = said.iter().position(|verdict| verdict.wish == Wish::Open).unwrap_or(said.len());
        cost += (opened as f64 - supported - 5.0).max(0.0) / HZ * BROKEN;
    }
    // Bursts of 1.5 s are answered, and none the other way.
    let since = |t: f64| (t - 1.0).rem_euclid(2.5);
    for (peak, wish, other) in [(close, Wish::Close, Wish::Open), (open, Wish::Open, Wish::Close)] {
        for rise_s in [0.05, 0.2] {
            let said = play(fitted, model, 8.0, |t, n| {
                let burst = (since(t) / rise_s).min(1.0) * ((1.5 - since(t)) / 0.1).clamp(0.0, 1.0);
                let up = if t < 1.0 { 0.0 } else { burst };
                resting(t, n) + up * (alive(1.5 * peak[n], t, n) - rest[n]).max(0.0)
            });
            let is_held = |t: f64| t > 1.0 && since(t) > rise_s + 0.1 && since(t) < 1.4;
            let timed = said.iter().enumerate().map(|(n, verdict)| (n as f64 / HZ, verdict.wish == wish));
            let held: Vec<bool> = timed.filter(|(t, _)| is_held(*t)).map(|(_, is_right)| is_right).collect();
            let right = held.iter().filter(|is_right| **is_right).count() as f64 / held.len() as f64;
            cost += ((0.95 - right).max(0.0) + lasts_s(&said, other)) * BROKEN;
        }
    }
    cost
}
