//! Whether a network may judge an array: one of another noise than it has learned on is refused.

use std::collections::BTreeMap;

use anyhow::bail;
use tenax_logic::array::ELEMENTS;

use super::network::Network;
use crate::labelled::{Recording, Step};

/// Factor below or above the learned noise from which a network refuses: the error of estimating it.
const BEYOND: f64 = 1.1;

/// Rms change from a reading to the next beyond what all elements do together, samples: the median over the steps.
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

fn noise_of(recordings: &[&Recording]) -> f64 {
    let mut all: Vec<f64> = recordings.iter().map(|recording| noise_samples(&recording.steps)).collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 4).copied().unwrap_or_default()
}

pub fn accept(network: &Network, recordings: &[Recording]) -> anyhow::Result<()> {
    let [low, high] = network.noise_samples;
    let mut sessions: BTreeMap<&str, Vec<&Recording>> = BTreeMap::new();
    for recording in recordings {
        sessions.entry(recording.session.as_str()).or_default().push(recording);
    }
    for (session, own) in sessions {
        let noise = noise_of(&own);
        if !(low / BEYOND..=high * BEYOND).contains(&noise) {
            bail!(
                "{session}: a reading of this array differs from the one before by {noise:.1} samples (14 bits); the network \
                 learned on arrays of {low:.1} to {high:.1} and would take the rest for slip or for rest; `python -m tenax.train` learns \
                 from recordings of one's own (docs/array.md)"
            );
        }
    }
    Ok(())
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
        assert!(said.contains("tenax.train") && said.contains("samples"), "{said}");
    }
}
