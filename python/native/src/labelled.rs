//! Labelled recordings of the force array, and the edges of a trained network's verdict.

use std::path::Path;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use tenax_logic::array::{COVARIANCE_WINDOW, PreprocessorConfig};
use tenax_sim::array::network::Network;
use tenax_sim::array::{adapt, edges};
use tenax_sim::labelled::{self, ArrayRecipe, Part, Recording, library};
use tenax_sim::scorer::Doing;

use crate::refused;

fn read(path: &str, recipe: Option<&str>) -> anyhow::Result<(ArrayRecipe, Vec<Recording>)> {
    let recipe = library::choose(Path::new(path), recipe)?;
    let recordings = labelled::read(Path::new(path), &recipe)?;
    Ok((recipe, recordings))
}

/// Recordings of a labelled file: samples (14 bits, 80 rows a second), where they slip, and `noise`, the rms change between readings;
/// and the recipe's lag, window and knees of features.
#[pyfunction]
pub fn labelled_recordings<'py>(
    py: Python<'py>,
    path: &str,
    recipe: Option<&str>,
) -> PyResult<(Vec<Bound<'py, PyDict>>, [u32; 5])> {
    let (recipe, recordings) = read(path, recipe).map_err(refused)?;
    let table = |own: &Recording| {
        let table = PyDict::new(py);
        table.set_item("session", &own.session)?;
        table.set_item("material", &own.material)?;
        table.set_item("part", own.part.map(Part::name))?;
        table.set_item("pours", own.doing == Doing::Pour)?;
        table.set_item("disturbs", own.doing == Doing::Disturb)?;
        table.set_item("noise", adapt::noise_samples(&own.steps))?;
        let samples: Vec<Vec<u16>> = own.steps.iter().map(|step| step.samples.to_vec()).collect();
        table.set_item("samples", PyArray2::from_vec2(py, &samples)?)?;
        table.set_item("slips", PyArray1::from_iter(py, own.steps.iter().map(|step| step.slip)))?;
        Ok(table)
    };
    let given = &recipe.features;
    let default = PreprocessorConfig::DEFAULT;
    let features = [
        given.lag.as_ref().map_or(default.lag, |lag| *lag.get_ref()).into(),
        given.window.as_ref().map_or(COVARIANCE_WINDOW as u32, |window| (*window.get_ref()).into()),
        given.covariance_knee.unwrap_or(default.covariance_knee),
        given.spectrum_knee.unwrap_or(default.spectrum_knee),
        given.structure_knee.unwrap_or(default.structure_knee),
    ];
    Ok((recordings.iter().map(table).collect::<PyResult<_>>()?, features))
}

/// The two edges (JSON, with their scores) that suit a network (JSON) best in the pours of a file's validation part. None without pours,
/// or where no edges are quiet enough. Fails if the network is none of the firmware's.
#[pyfunction]
pub fn edges_of(path: &str, recipe: Option<&str>, network: &str) -> PyResult<Option<String>> {
    let chosen = || -> anyhow::Result<Option<String>> {
        let network = Network::of(&serde_json::from_str(network)?)?;
        let (_, mut recordings) = read(path, recipe)?;
        recordings.retain(|own| own.part == Some(Part::Validation) && own.doing == Doing::Pour);
        let judged: Vec<_> = recordings.iter().map(|own| (own, network.confidences(&own.steps))).collect();
        Ok(edges::choose(&judged).map(|chosen| serde_json::to_string(&chosen)).transpose()?)
    };
    chosen().map_err(refused)
}
