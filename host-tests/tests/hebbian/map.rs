//! Fate of the network over alpha and beta.

use tenax_logic::hebbian::{Code, Codes, Config, FingertipNetwork, RECEPTORS, Rule};

use super::oracle::{exact, weights_of};
use super::task::{Finger, Moment};

/// Mean of o1 over [`WINDOW_MS`] below which slip is reported.
const SLIP_BELOW: f64 = -0.2;
pub const UNSEEN: u64 = 1_000;
/// Shortest time that is judged, ms.
const WINDOW_MS: usize = 50;

/// Fate of a network, in the order of the questions; each with its letter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Fate {
    /// One connection has more than half of the weight of an output.
    Runaway = b'1',
    /// o1 stays within 0.1 on average during slip.
    Dead = b'.',
    /// o1 is at its limit for more than 0.9 of the slip.
    Saturated = b'S',
    /// Slip is reported in more than 1 % of holding, or the wrong direction in more than 1 % of slip.
    Wrong = b'x',
    /// Slip is reported in less than 95 % of its time.
    Weak = b'w',
    /// None of these.
    Useful = b'U',
}

/// Scores of the touch-only outputs in a trial that was not learned from, as parts of its time.
#[derive(Clone, Copy, Debug)]
pub struct Said {
    pub o1_slip: f64,
    pub at_end: f64,
    pub slip_seen: f64,
    pub false_slip: f64,
    /// Right sign of o2 during slip.
    pub direction: f64,
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

pub fn ask(weights: &[[f64; RECEPTORS]; 2], trial: &[Moment]) -> Said {
    let part = |is: bool| f64::from(u8::from(is));
    let judged = trial.chunks_exact(WINDOW_MS).map(|window| {
        let outputs = window.iter().map(|moment| {
            let t = exact(&moment.felt);
            weights.map(|row| row.iter().zip(t).map(|(w, t)| w * t).sum::<f64>().clamp(-1.0, 1.0))
        });
        let outputs: Vec<_> = outputs.collect();
        let [o1, o2] = [0, 1].map(|n: usize| mean(outputs.iter().map(|outputs| outputs[n])));
        (window[0].truth, o1, o2, mean(outputs.iter().map(|outputs| part(outputs[0] <= -1.0))))
    });
    let (slips, holds): (Vec<_>, Vec<_>) = judged.partition(|(truth, ..)| truth[0] == Code::Minus);
    let right = |(truth, _, o2, _): &(Codes, f64, f64, f64)| o2 * f64::from(truth[1].sign()) > 0.0;
    Said {
        o1_slip: mean(slips.iter().map(|(_, o1, ..)| o1.abs())),
        at_end: mean(slips.iter().map(|(.., at_end)| *at_end)),
        slip_seen: mean(slips.iter().map(|(_, o1, ..)| part(*o1 < SLIP_BELOW))),
        false_slip: mean(holds.iter().map(|(_, o1, ..)| part(*o1 < SLIP_BELOW))),
        direction: mean(slips.iter().map(|slip| part(right(slip)))),
    }
}

pub fn largest_part(row: &[f64; RECEPTORS]) -> f64 {
    let sum: f64 = row.iter().map(|w| w.abs()).sum();
    row.iter().fold(0.0f64, |largest, w| largest.max(w.abs())) / sum.max(f64::MIN_POSITIVE)
}

pub fn fate(weights: &[[f64; RECEPTORS]; 2], trial: &[Moment]) -> Fate {
    let said = ask(weights, trial);
    if weights.iter().any(|row| largest_part(row) > 0.5) {
        Fate::Runaway
    } else if said.o1_slip < 0.1 {
        Fate::Dead
    } else if said.at_end > 0.9 {
        Fate::Saturated
    } else if said.false_slip > 0.01 || said.direction < 0.99 {
        Fate::Wrong
    } else if said.slip_seen < 0.95 {
        Fate::Weak
    } else {
        Fate::Useful
    }
}

pub fn teach(network: &mut FingertipNetwork, config: &Config, moments: &[Moment]) {
    let rule = Rule::of(config);
    for moment in moments {
        if let Some(codes) = moment.lesson() {
            network.learn(&rule, &moment.felt, &codes.map(Some));
        }
    }
}

pub fn learned(config: &Config, moments: &[Moment]) -> FingertipNetwork {
    let mut network = FingertipNetwork::default();
    teach(&mut network, config, moments);
    network
}

/// Letters of networks that learned at these alphas, at the default delta and each beta.
fn fates(alphas_ppb: &[u32], beta_ppb: u32) -> String {
    let finger = Finger::new(1);
    let (lesson, trial) = (finger.lesson(), finger.trial(UNSEEN));
    let fate = |&alpha_ppb: &u32| {
        let config = Config { alpha_ppb, beta_ppb, ..Config::default() };
        char::from(fate(&weights_of(&learned(&config, &lesson)), &trial) as u8)
    };
    alphas_ppb.iter().map(fate).collect()
}

#[test]
fn the_defaults_lie_in_the_middle_of_the_useful_region() {
    let Config { alpha_ppb, beta_ppb, .. } = Config::default();
    let alphas_ppb =
        [alpha_ppb / 50, alpha_ppb / 5, alpha_ppb * 2 / 5, alpha_ppb, 2 * alpha_ppb, 10 * alpha_ppb];
    for (beta_ppb, held) in [
        (beta_ppb / 2, ".UUUUS"),
        (beta_ppb, ".wUUUS"),
        (2 * beta_ppb, ".wUUUS"),
        // It forgets within a trial.
        (500 * beta_ppb, "....xx"),
    ] {
        assert_eq!(fates(&alphas_ppb, beta_ppb), held, "beta {beta_ppb} ppb");
    }
}
