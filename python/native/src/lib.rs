//! The extension module below the package `tenax`: the firmware's logic and its worlds, with arrays in and out.

mod columns;
mod detect;
mod fingertip;
mod vision;
mod world;

use std::path::Path;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use tenax_hal_shim::channel::CHANNELS;
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::words::{DriveSource, GripMode};
use tenax_logic::setting::SettingId;
use tenax_scene::drawn::Family;
use tenax_sim::live::Use;
use tenax_sim::session::{self, Board};

use crate::columns::Kept;

fn refused(error: impl Into<anyhow::Error>) -> PyErr {
    PyValueError::new_err(format!("{:#}", error.into()))
}

/// Number, name, unit, least, most, default and meaning of every setting.
#[pyfunction]
fn settings() -> Vec<(u8, &'static str, &'static str, i32, i32, i32, &'static str)> {
    let row = |id: SettingId| {
        let row = id.row();
        (id.number(), row.name, row.unit, row.min, row.max, row.default, row.meaning)
    };
    SettingId::ALL.into_iter().map(row).collect()
}

/// Name, length (s) and title of every scene that ships.
#[pyfunction]
fn scenes() -> PyResult<Vec<(&'static str, f64, String)>> {
    let row = |&(name, text): &(&'static str, &str)| {
        let file = tenax_scene::SceneFile::parse(text, name).map_err(refused)?;
        Ok((name, file.duration_s(), file.title))
    };
    tenax_scene::builtin().iter().map(row).collect()
}

/// The scene file of a drawn world, and the seed of its noise.
#[pyfunction]
#[pyo3(signature = (family, seed, n))]
fn drawn(family: Option<&str>, seed: u64, n: u32) -> PyResult<(String, u64)> {
    let drawn = world::nth_drawn(family, seed, n)?;
    Ok((drawn.text, drawn.noise_seed))
}

/// Report (JSON) and line of a scene on the host's board. Without `bound` there is no search for the least force.
#[pyfunction]
fn run(py: Python<'_>, scene: &str, seed: u64, bound: bool) -> PyResult<(String, Vec<u8>)> {
    let done = py.detach(|| {
        let (file, mut kept) = (session::load_scene(scene)?, Kept::default());
        let line = Use { without_bound: !bound, ..Use::default() };
        let outcome = session::scene_served(&file, seed, &Board::Host, line, &mut kept, &mut |_| {})?;
        Ok((serde_json::to_string(&outcome.report)?, kept.line))
    });
    done.map_err(|error: anyhow::Error| refused(error))
}

/// Report (JSON) and line of a recording, by `recipe` or by the one that its name calls for, on the host's board.
#[pyfunction]
#[pyo3(signature = (path, recipe, seed))]
fn replay(py: Python<'_>, path: &str, recipe: Option<&str>, seed: u64) -> PyResult<(String, Vec<u8>)> {
    let done = py.detach(|| {
        let (mut kept, by) = (Kept::default(), (recipe, None));
        let line = Use::default();
        let outcome =
            session::replay_served(Path::new(path), by, line, seed, &Board::Host, &mut kept, &mut |_| {})?;
        Ok((serde_json::to_string(&outcome.report)?, kept.line))
    });
    done.map_err(|error: anyhow::Error| refused(error))
}

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("CHANNELS", CHANNELS.map(|channel| channel.name))?;
    module.add("REST_V", CHANNELS.map(|channel| f64::from(channel.rest_mv) / 1e3))?;
    module.add("DETECTORS", DetectorId::ALL.map(DetectorId::name))?;
    module.add("MODES", GripMode::ALL.map(GripMode::name))?;
    module.add("SOURCES", DriveSource::ALL.map(DriveSource::name))?;
    module.add("FAMILIES", Family::ALL.map(Family::name))?;
    module.add("OBSERVED", world::observed())?;
    module.add_class::<fingertip::Fingertip>()?;
    module.add_class::<world::World>()?;
    module.add_class::<vision::Camera>()?;
    module.add_class::<vision::Skin>()?;
    module.add_function(wrap_pyfunction!(settings, module)?)?;
    module.add_function(wrap_pyfunction!(scenes, module)?)?;
    module.add_function(wrap_pyfunction!(drawn, module)?)?;
    module.add_function(wrap_pyfunction!(run, module)?)?;
    module.add_function(wrap_pyfunction!(replay, module)?)?;
    module.add_function(wrap_pyfunction!(fingertip::pins, module)?)?;
    module.add_function(wrap_pyfunction!(detect::s1, module)?)?;
    module.add_function(wrap_pyfunction!(detect::s2, module)?)?;
    module.add_function(wrap_pyfunction!(detect::hebbian, module)?)?;
    module.add_function(wrap_pyfunction!(detect::mlp, module)?)?;
    module.add_function(wrap_pyfunction!(detect::photoelastic, module)?)?;
    module.add_function(wrap_pyfunction!(detect::features, module)?)?;
    Ok(())
}
