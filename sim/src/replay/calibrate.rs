//! The guided calibration from recordings: each prompt is answered with one.

use std::path::PathBuf;

use anyhow::{anyhow, bail};
use tenax_logic::emg::model::EmgModel;

use super::muscles::{self, Muscles};

/// Calibrates to the wearer of these recordings: rest, close, open. Of each, the first 5 s as the board reads them.
/// Fails if one cannot be read or has no recipe, or the calibration is refused.
pub fn calibrate(recordings: &[PathBuf], recipe: Option<&str>, seed: u64) -> anyhow::Result<EmgModel> {
    let [rest, close, open] = recordings else {
        bail!("a calibration takes three recordings: REST.csv,CLOSE.csv,OPEN.csv");
    };
    let read = |path: &PathBuf| Muscles::read(path, recipe, seed);
    let (rest, close, open) = (read(rest)?, read(close)?, read(open)?);
    muscles::calibrate([&rest, &close, &open])
        .map_err(|refusal| anyhow!("the calibration is refused: {refusal}"))
}
