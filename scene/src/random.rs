//! Noise: one numbered stream for each source, so that a source added later changes no other one's noise.

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use rand_distr::StandardNormal;

/// Who draws. New sources are added at the end: their place is their stream.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Source {
    /// Gains, signs and depths of the PVDF films.
    FilmMaking,
    /// What the PVDF films hear.
    Film,
    /// The wandering of the myoelectric envelopes.
    Myo,
    /// The converter.
    Converter,
}

/// A source's stream of numbers.
#[derive(Debug)]
pub(crate) struct Noise(ChaCha8Rng);

impl Noise {
    pub(crate) fn new(seed: u64, source: Source) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(source as u64);
        Self(rng)
    }

    /// Normally distributed, mean 0, standard deviation 1.
    pub(crate) fn normal(&mut self) -> f64 {
        self.0.sample(StandardNormal)
    }

    /// Evenly distributed from `low` to `high`.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    /// -1 or 1.
    pub(crate) fn sign(&mut self) -> f64 {
        if self.0.random::<bool>() { 1.0 } else { -1.0 }
    }
}
