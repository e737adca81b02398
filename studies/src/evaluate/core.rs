//! The shipped network on the emulated core against the same network on this machine, bit for bit.

use std::path::Path;

use anyhow::{Context, Result, bail};
use rayon::prelude::*;
use tenax_logic::array::{Reading, ShippedDetector};

use tenax_bench::array::readings;
use tenax_bench::board::emulated::kernels::{self, Answer, Kernels};
use tenax_bench::labelled::Recording;

/// Puts recordings through the detector of the kernels' `image`
/// ([`build_kernels`](tenax_bench::image::build_kernels)) and through this machine's; gives the number of steps in which
/// features, logit, verdict, confidence and age were compared. `progress` is told the part that is done, 0 to 1.
/// An error says in which step of which recording they first differ; or if the image does not run.
pub fn compare(image: &Path, recordings: &[Recording], progress: &mut dyn FnMut(f64)) -> Result<usize> {
    let read: Vec<Vec<Reading>> = recordings.par_iter().map(|recording| readings(&recording.steps)).collect();
    let steps: usize = read.iter().map(Vec::len).sum();
    let mut told = |answered: usize| progress(answered as f64 / steps.max(1) as f64);
    let answers = kernels::run(image, &read, Kernels::Detector, &mut told)?.answers;
    for ((recording, readings), answers) in recordings.iter().zip(&read).zip(&answers) {
        let mut detector = ShippedDetector::default();
        for (n, reading) in readings.iter().enumerate() {
            let here = Answer::of(&mut detector, reading);
            let there = answers.get(n).with_context(|| format!("the core left out step {n}"))?;
            if here != *there {
                bail!("{}, step {n}: the core says {there:?}, this machine {here:?}", recording.name);
            }
        }
    }
    Ok(steps)
}
