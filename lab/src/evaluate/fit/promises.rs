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
    wearers: Vec<EmgModel>,
}

/// The scenes' wearer, and one each of the shared sessions, as in the tests of `host-tests`.
const WEARERS_MV: [[[i32; 2]; 3]; 4] = [
    [[50, 50], [900, 95], [80, 560]],
    [[50, 50], [450, 72], [87, 750]],
    [[61, 48], [445, 165], [156, 1_490]],
    [[65, 141], [289, 161], [94, 989]],
];

fn alive(mv: f64, t_s: f64, k: usize) -> f64 {
    let tau = std::f64::consts::TAU;
    let [slow, fast] = [[2.7, 5.3], [2.3, 4.9]][k];
    mv * (1.0 + 0.12 * (tau * slow * t_s).sin() + 0.1 * (tau * fast * t_s + 1.0).sin())
}

impl<'a> Promises<'a> {
    pub fn of(sessions: &'a [Session]) -> Self {
        let uv = |pairs: [[i32; 2]; 3]| pairs.map(|pair| pair.map(|mv| 1_000 * mv));
        let wearers = WEARERS_MV.iter().filter_map(|&pairs| {
            let [rest, close, open] = uv(pairs);
            EmgModel::of_uv(rest, close, open).ok()
        });
        Self { sessions, wearers: wearers.collect() }
    }

    pub fn cost(&self, fitted: &'static Fitted) -> f64 {
        let muscles: f64 =
            self.wearers.iter().zip(WEARERS_MV).map(|(model, mv)| of_muscles(fitted, model, mv)).sum();
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

/// Plays made-up envelopes, mV, after a second of rest.
fn play(
    fitted: &'static Fitted,
    model: &EmgModel,
    seconds: f64,
    of: impl Fn(f64) -> [f64; 2],
) -> Vec<Verdict> {
    let mut emg = Emg::of(Decide::with(fitted, Some(model)));
    (0..(seconds * HZ) as u32)
        .map(|n| emg.take(of(f64::from(n) / HZ).map(|mv| Some((mv.clamp(-300.0, 2_900.0) * 1e3) as i32))))
        .collect()
}

fn of_muscles(fitted: &'static Fitted, model: &EmgModel, [rest, close, open]: [[i32; 2]; 3]) -> f64 {
    let rest = rest.map(f64::from);
    let resting = |t: f64| [0, 1].map(|n| rest[n] * (1.0 + 0.05 * ((3.0 - n as f64) * t * 6.0).sin()));
    let mut cost = 0.0;
    // Both muscles at once ask for nothing.
    for [flexor, extensor] in [[300.0, 300.0], [500.0, 500.0], [800.0, 800.0], [1_500.0, 1_500.0]] {
        let said = play(fitted, model, 3.0, |t| {
            if t < 1.0 { resting(t) } else { [alive(flexor, t, 0), alive(extensor, t, 1)] }
        });
        let opens = said.iter().filter(|verdict| verdict.wish == Wish::Open).count();
        cost += opens as f64 / HZ * BROKEN;
    }
    // An opening of a quarter above the calibrated one is answered at once, whatever the flexor is thought of.
    for rise_s in [0.03, 0.15, 0.3] {
        let open = open.map(f64::from);
        let up = |t: f64| ((t - 1.0) / rise_s).clamp(0.0, 1.0);
        let said = play(fitted, model, 3.0, |t| {
            [0, 1].map(|n| {
                resting(t)[n] + up(t) * ([1.0, 1.5][n] * open[n] - rest[n]) * alive(1.0, t, n).clamp(0.9, 1.2)
            })
        });
        let supported = (1.0 + rise_s) * HZ;
        let opened = said.iter().position(|verdict| verdict.wish == Wish::Open).unwrap_or(said.len());
        cost += (opened as f64 - supported - 5.0).max(0.0) / HZ * BROKEN;
    }
    // Bursts are answered, and none the other way.
    for (peak, wish, other) in [(close, Wish::Close, Wish::Open), (open, Wish::Open, Wish::Close)] {
        for rise_s in [0.05, 0.2] {
            let said = play(fitted, model, 8.0, |t| {
                let since = (t - 1.0).rem_euclid(2.5);
                let up = if t < 1.0 {
                    0.0
                } else {
                    (since / rise_s).min(1.0) * ((1.5 - since) / 0.1).clamp(0.0, 1.0)
                };
                [0, 1].map(|n| {
                    let over = 1.5 * f64::from(peak[n]);
                    resting(t)[n] + up * (alive(over, t, n) - rest[n]).max(0.0)
                })
            });
            let held = |n: usize| {
                let t = n as f64 / HZ;
                let since = (t - 1.0).rem_euclid(2.5);
                t > 1.0 && since > rise_s + 0.1 && since < 1.4
            };
            let held: Vec<_> = said.iter().enumerate().filter(|(n, _)| held(*n)).collect();
            let right =
                held.iter().filter(|(_, verdict)| verdict.wish == wish).count() as f64 / held.len() as f64;
            let wrong = said.iter().filter(|verdict| verdict.wish == other).count() as f64 / HZ;
            cost += (0.95 - right).max(0.0) * BROKEN + wrong * BROKEN;
        }
    }
    cost
}
