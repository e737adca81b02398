//! A stranger's array: whether a network may judge it, and how it adapts to it.
//!
//! A network has learned on arrays of some noise. What lies outside of that it takes for something else, so it refuses, and says
//! what it measured. `--adapt N` takes the first N seconds in which something is held and does not slip: they give the scale,
//! which brings the array's noise into what was learned, and the threshold, which one of a hundred quiet steps exceeds. If the array's
//! noise is one that was learned, the threshold is not below the network's own: a few quiet seconds are too quiet by chance. Those
//! seconds are not scored. Which quiet recordings come first is chance, too, so each of them once is the first.

use std::collections::BTreeMap;

use anyhow::{bail, ensure};
use tenax_hal_shim::channel::{SAMPLE_MAX, SLOW_HZ};
use tenax_logic::array::ELEMENTS;

use super::network::Network;
use super::readings;
use super::real::Logits;
use crate::labelled::{Recording, Step};

/// A noise may be so many times less or more than what was learned before a network refuses: what estimating it is off by.
const BEYOND: f64 = 1.1;
/// One of so many quiet steps may be called slip.
const QUIET_PART: f64 = 0.01;

/// How much readings of a recording differ from one to the next, as an rms over what the elements do apart, samples. The median
/// over the steps: a slip for less than half of the time does not change it.
pub fn noise_samples(steps: &[Step]) -> f64 {
    let mut squares: Vec<f64> = steps
        .windows(2)
        .map(|pair| {
            let change: [f64; ELEMENTS] =
                std::array::from_fn(|n| f64::from(pair[1].samples[n]) - f64::from(pair[0].samples[n]));
            let mean = change.iter().sum::<f64>() / ELEMENTS as f64;
            change.iter().map(|change| (change - mean).powi(2)).sum::<f64>() / (ELEMENTS - 1) as f64
        })
        .collect();
    if squares.is_empty() {
        return 0.0;
    }
    let middle = squares.len() / 2;
    squares.select_nth_unstable_by(middle, f64::total_cmp);
    // The median of a chi-squared variable of nine degrees of freedom over its mean.
    (squares[middle] / (8.343 / 9.0)).sqrt()
}

/// The noise of an array from its recordings: of the quietest quarter of them, the loudest.
pub fn noise_of(recordings: &[&Recording]) -> f64 {
    let mut all: Vec<f64> = recordings.iter().map(|recording| noise_samples(&recording.steps)).collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 4).copied().unwrap_or_default()
}

/// Refuses recordings of an array whose noise the network has not learned.
/// An error says what was measured, what was learned, and what to do.
pub fn accept(network: &Network, recordings: &[Recording]) -> anyhow::Result<()> {
    let [low, high] = network.noise_samples;
    for (session, own) in sessions(recordings) {
        let noise = noise_of(&own);
        if !(low / BEYOND..=high * BEYOND).contains(&noise) {
            bail!(
                "{session}: a reading of this array differs from the one before by {noise:.1} samples (14 bits); the network \
                 learned on arrays of {low:.1} to {high:.1} and would take the rest for slip or for rest. --adapt N fits it to \
                 N seconds of quiet holding; `tenax train` learns from recordings of one's own (docs/training.md)"
            );
        }
    }
    Ok(())
}

/// Recordings judged by a network that has adapted to their sessions: those left to score, with logits and thresholds.
#[derive(Clone, Debug, Default)]
pub struct Judged {
    /// What is left.
    pub recordings: Vec<Recording>,
    /// Of each step of them.
    pub logits: Vec<Logits>,
    pub on: Vec<i32>,
}

/// Adapts to `quiet_s` seconds without slip of each session, and judges the rest: once beginning with each of its quiet recordings.
/// Fails if a session has no quiet recording that is long enough for the network's windows.
pub fn adapt(network: &Network, recordings: &[Recording], quiet_s: f64) -> anyhow::Result<Vec<Judged>> {
    let sessions: Vec<Session> = sessions(recordings).into_iter().map(Session::of).collect();
    let times = sessions.iter().map(|session| session.quiet.len()).min().unwrap_or_default();
    (0..times.max(1))
        .map(|first| {
            let mut judged = Judged::default();
            for session in &sessions {
                session.judge(network, first, quiet_s, &mut judged)?;
            }
            Ok(judged)
        })
        .collect()
}

struct Session<'a> {
    name: &'a str,
    recordings: Vec<&'a Recording>,
    /// Those of them in which nothing slips.
    quiet: Vec<&'a Recording>,
}

impl<'a> Session<'a> {
    fn of((name, recordings): (&'a str, Vec<&'a Recording>)) -> Self {
        let is_quiet = |own: &&Recording| own.steps.iter().all(|step| !step.slip);
        Self { name, quiet: recordings.iter().copied().filter(is_quiet).collect(), recordings }
    }

    /// Adapts to the quiet recordings from the `first` on.
    fn judge(
        &self,
        network: &Network,
        first: usize,
        quiet_s: f64,
        judged: &mut Judged,
    ) -> anyhow::Result<()> {
        let (mut quiet, mut steps) = (Vec::new(), 0.0);
        for &recording in self.quiet.iter().cycle().skip(first).take(self.quiet.len()) {
            if steps >= quiet_s * f64::from(SLOW_HZ) {
                break;
            }
            steps += recording.steps.len() as f64;
            quiet.push(recording);
        }
        let scale = scale(network, noise_of(&quiet));
        let mut logits: Vec<i32> = quiet
            .iter()
            .flat_map(|recording| network.judge(&readings(&scaled(&recording.steps, scale))).0)
            .flatten()
            .collect();
        ensure!(
            !logits.is_empty(),
            "{}: no recording in which nothing slips is long enough to adapt to",
            self.name
        );
        logits.sort_unstable();
        let rank = ((1.0 - QUIET_PART) * logits.len() as f64) as usize;
        let own = if scale == 1.0 { network.on() } else { i32::MIN };
        let on = logits[rank.min(logits.len() - 1)].saturating_add(1).max(own);
        for &recording in &self.recordings {
            if quiet.iter().any(|used| used.name == recording.name) {
                continue;
            }
            judged.logits.push(network.judge(&readings(&scaled(&recording.steps, scale))).0);
            judged.recordings.push(recording.clone());
            judged.on.push(on);
        }
        Ok(())
    }
}

/// What brings a noise into what was learned: 1 if it is there.
fn scale(network: &Network, noise: f64) -> f64 {
    let [low, high] = network.noise_samples;
    if noise > 0.0 { noise.clamp(low, high) / noise } else { 1.0 }
}

fn scaled(steps: &[Step], scale: f64) -> Vec<Step> {
    let Some(first) = steps.first() else { return Vec::new() };
    steps
        .iter()
        .map(|step| {
            let sample = |n: usize| {
                let rest = f64::from(first.samples[n]);
                (rest + scale * (f64::from(step.samples[n]) - rest)).round().clamp(0.0, f64::from(SAMPLE_MAX))
            };
            Step { samples: std::array::from_fn(|n| sample(n) as u16), slip: step.slip }
        })
        .collect()
}

fn sessions(recordings: &[Recording]) -> BTreeMap<&str, Vec<&Recording>> {
    let mut all: BTreeMap<&str, Vec<&Recording>> = BTreeMap::new();
    for recording in recordings {
        all.entry(recording.session.as_str()).or_default().push(recording);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{SeedableRng, rngs::ChaCha8Rng};
    use rand_distr::{Distribution, StandardNormal};

    fn noisy(samples: f64) -> Recording {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut draw = || -> f64 { StandardNormal.sample(&mut rng) };
        let steps = (0..400)
            .map(|_| Step {
                samples: std::array::from_fn(|_| (4_000.0 + samples * draw()).round() as u16),
                slip: false,
            })
            .collect();
        Recording::of_steps("noisy", steps)
    }

    #[test]
    fn the_noise_is_that_of_a_difference() {
        let found = noise_samples(&noisy(10.0).steps);
        assert!((found / (10.0 * std::f64::consts::SQRT_2) - 1.0).abs() < 0.05, "{found}");
    }

    #[test]
    fn an_array_that_is_noisier_than_what_was_learned_is_refused_and_one_like_it_is_not() {
        let network = Network::shipped();
        assert!(accept(&network, &[noisy(5.0)]).is_ok());
        let said = accept(&network, &[noisy(60.0)]).unwrap_err().to_string();
        assert!(said.contains("--adapt") && said.contains("samples"), "{said}");
        assert!((scale(&network, 60.0 * 1.414) * 60.0 * 1.414 / network.noise_samples[1] - 1.0).abs() < 1e-9);
    }
}
