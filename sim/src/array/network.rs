//! A network to be judged: the one that ships, or one that `python -m tenax.train` has written.

use std::path::Path;

use anyhow::{Context, anyhow, ensure};
use serde::{Deserialize, Serialize};
use tenax_hal_shim::channel::{REFERENCE_MV, SAMPLE_MAX};
use tenax_logic::array::detector::logistic_permille;
use tenax_logic::array::{
    ArrayDetector, COVARIANCE_WINDOW, Judgement, Layer, Mlp, Model, PreprocessorConfig, Reading, shipped,
};

use super::edges::{Confidences, Edges};
use super::material::SEEN;
use super::real::Logits;
use crate::labelled::Step;

const FILE: &str = "network.json";

/// A network as `python -m tenax.train` writes it: the firmware's integers, what its features are made with, and on what noise it learned.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    pub sha256: String,
    pub lag: u8,
    pub window: usize,
    /// See [`PreprocessorConfig`].
    pub covariance_knee: u32,
    pub spectrum_knee: u32,
    pub structure_knee: u32,
    pub first: (Vec<Vec<i16>>, Vec<i32>, u32),
    pub second: (Vec<Vec<i16>>, Vec<i32>, u32),
    pub last: (Vec<i16>, i32),
    pub logit_per_nat: i32,
    #[serde(flatten)]
    pub edges: Edges,
    pub noise_samples: [f64; 2],
}

#[derive(Clone, Debug)]
pub struct Network {
    model: Box<Model>,
    pub noise_samples: [f64; 2],
}

impl Network {
    pub fn shipped() -> Self {
        let ends = |end: usize| SEEN.map(|material| material.contact.noise_mv[end]);
        let samples =
            |mv: f64| mv * f64::from(SAMPLE_MAX) / f64::from(REFERENCE_MV) * std::f64::consts::SQRT_2;
        let low = ends(0).into_iter().fold(f64::INFINITY, f64::min);
        let high = ends(1).into_iter().fold(0.0, f64::max);
        Self { model: Box::new(shipped::MODEL.clone()), noise_samples: [samples(low), samples(high)] }
    }

    /// One from a folder that `python -m tenax.train` has written. Fails if there is none, or it is none of the firmware's.
    pub fn read(folder: &Path) -> anyhow::Result<Self> {
        let file = folder.join(FILE);
        let text = std::fs::read_to_string(&file).with_context(|| {
            format!("{}: no network; `python -m tenax.train --out DIR` writes one", file.display())
        })?;
        let saved: Saved = serde_json::from_str(&text).with_context(|| file.display().to_string())?;
        Self::of(&saved).with_context(|| file.display().to_string())
    }

    /// Fails if it is none of the firmware's.
    pub fn of(saved: &Saved) -> anyhow::Result<Self> {
        ensure!(saved.noise_samples[0] <= saved.noise_samples[1], "its noise is no range");
        ensure!(
            saved.window == COVARIANCE_WINDOW,
            "it has a covariance of {} differences; {COVARIANCE_WINDOW} can be judged",
            saved.window
        );
        Ok(Self { model: Box::new(saved.model()?), noise_samples: saved.noise_samples })
    }

    pub fn confidences(&self, steps: &[Step]) -> Confidences {
        let per_nat = self.model.judgement.logit_per_nat;
        let (logits, _) = self.judge(&super::readings(steps));
        logits.into_iter().map(|logit| logit.map(|logit| logistic_permille(logit, per_nat))).collect()
    }

    /// The logit of each reading of one recording, and whether it says slip.
    pub fn judge(&self, readings: &[Reading]) -> (Logits, Vec<bool>) {
        let mut detector = ArrayDetector::new(&self.model);
        readings
            .iter()
            .map(|reading| {
                let slip = detector.push(reading).slip;
                (detector.logit(), slip)
            })
            .unzip()
    }
}

impl Saved {
    fn model(&self) -> anyhow::Result<Model> {
        let too_large = |_| anyhow!("a sum of the network could overflow");
        let (first, second, last) = (&self.first, &self.second, &self.last);
        Ok(Model {
            preprocessor: PreprocessorConfig {
                lag: self.lag,
                covariance_knee: self.covariance_knee,
                spectrum_knee: self.spectrum_knee,
                structure_knee: self.structure_knee,
                ..PreprocessorConfig::DEFAULT
            },
            network: Mlp {
                first: Layer::new(square(&first.0)?, fixed(&first.1)?, first.2).map_err(too_large)?,
                second: Layer::new(square(&second.0)?, fixed(&second.1)?, second.2).map_err(too_large)?,
                last: Layer::new([fixed(&last.0)?], [last.1], 0).map_err(too_large)?,
            },
            judgement: Judgement {
                logit_per_nat: self.logit_per_nat,
                on_permille: self.edges.on_permille,
                off_permille: self.edges.off_permille,
            },
        })
    }
}

/// Values of a layer of this size. Fails if there are more or fewer.
fn fixed<T: Clone, const N: usize>(values: &[T]) -> anyhow::Result<[T; N]> {
    <[T; N]>::try_from(values.to_vec()).ok().context("a layer of another size")
}

/// Weights of a layer of this size. Fails if they are of another.
fn square<const I: usize, const O: usize>(rows: &[Vec<i16>]) -> anyhow::Result<[[i16; I]; O]> {
    let rows: Vec<[i16; I]> = rows.iter().map(|row| fixed(row)).collect::<Result<_, _>>()?;
    fixed(&rows)
}
