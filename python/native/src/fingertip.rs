//! The fingertip as it runs in the image: frame by frame, or over a whole recording.

use numpy::ndarray::Axis;
use numpy::{PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use tenax_frames::words::words;
use tenax_hal_shim::channel::{COUNT, SCANS_PER_FRAME};
use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Event, Up};
use tenax_scene::plant::{Pins, Plant};
use tenax_sim::board::kept::Set;
use tenax_sim::board::simulated::{Grips, Stepper, frames_in, seconds_of};
use tenax_sim::replay::{Recipe, Recording, ReplayPlant};

use crate::columns::{self, Kept};
use crate::refused;

/// Columns of ticks and of slow frames; events' times, s, and words; the line.
type Told<'py> = (Bound<'py, PyDict>, Bound<'py, PyDict>, Vec<(f64, String)>, Bound<'py, PyBytes>);

/// Settings by name, as `tenax config` writes them.
pub type Settings = Vec<(String, i32)>;

/// Voltages of four scans, from outside.
#[derive(Default)]
struct Given {
    scans: [Pins; SCANS_PER_FRAME],
    next: usize,
}

impl Plant for Given {
    fn scan(&mut self, _drive: MotorDrive) -> &Pins {
        self.next += 1;
        &self.scans[(self.next - 1) % SCANS_PER_FRAME]
    }
}

#[pyclass]
pub struct Fingertip {
    settings: Settings,
    plant: Set<Given>,
    board: Stepper,
    kept: Kept,
    frames: u32,
}

#[pymethods]
impl Fingertip {
    #[new]
    fn new(settings: Settings) -> PyResult<Self> {
        let plant = Set::new(Given::default(), &settings).map_err(refused)?;
        let mut kept = Kept::default();
        let board = Stepper::new(&plant, Grips::Reflex(DetectorSet::ALL), &mut kept);
        Ok(Self { settings, plant, board, kept, frames: 0 })
    }

    /// One row of volts for the whole frame, or one for each of its four scans. Columns with one row.
    fn tick<'py>(
        &mut self,
        py: Python<'py>,
        volts: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let volts = volts.as_array();
        if !matches!(volts.dim(), (1 | SCANS_PER_FRAME, COUNT)) {
            return Err(PyValueError::new_err(format!(
                "a frame has 1 or {SCANS_PER_FRAME} rows of {COUNT} volts, not {:?}",
                volts.shape()
            )));
        }
        for (n, pins) in self.plant.plant.scans.iter_mut().enumerate() {
            let row = volts.index_axis(Axis(0), n % volts.len_of(Axis(0)));
            pins.0.iter_mut().zip(row).for_each(|(pin, volts)| *pin = *volts);
        }
        self.kept = Kept::default();
        self.board.frame(&mut self.plant, &mut self.kept);
        self.frames += 1;
        let fingertip = &self.board.device.fingertip;
        let tick = fingertip.last_tick().unwrap_or_default();
        columns::ticks(py, vec![seconds_of(self.frames)], &[(tick, fingertip.mode())])
    }

    /// Quantities of the slow frame that ended with the last tick. None: none did.
    fn state(&self) -> Option<Vec<(&'static str, f64)>> {
        self.kept.slows.last().map(|slow| columns::quantities(slow).to_vec())
    }

    /// Columns of ticks, columns of slow frames, and events, in the recording's time. A fresh board each time.
    #[pyo3(signature = (t_s, columns, recipe, seed))]
    fn run<'py>(
        &self,
        py: Python<'py>,
        t_s: PyReadonlyArray1<'py, f64>,
        columns: Vec<(String, PyReadonlyArray1<'py, f64>)>,
        recipe: Option<&str>,
        seed: u64,
    ) -> PyResult<Told<'py>> {
        let recording = recording(t_s, columns)?;
        let (mut ticks, mut kept, mut events) = (Vec::new(), Kept::default(), Vec::new());
        let zero_s = py.detach(|| {
            let plant = plant(&recording, recipe, seed)?;
            let zero_s = plant.time_zero_s();
            let mut plant = Set::new(plant, &self.settings).map_err(refused)?;
            let mut board = Stepper::new(&plant, Grips::Reflex(DetectorSet::ALL), &mut kept);
            for _ in 0..frames_in(plant.duration_s()) {
                board.frame(&mut plant, &mut kept);
                let fingertip = &board.device.fingertip;
                ticks.push((fingertip.last_tick().unwrap_or_default(), fingertip.mode()));
            }
            // In words, without the board's own time before them.
            let told = |event: Event| {
                let words = words(&Up::Event(event));
                (event.frame, words.split_once(" s ").map_or(words.clone(), |(_, what)| what.to_owned()))
            };
            events.extend(board.end().events.into_iter().map(told));
            Ok::<f64, PyErr>(zero_s)
        })?;
        let at = |frame: u32| zero_s + seconds_of(frame + 1);
        let ticks = columns::ticks(py, (0..ticks.len() as u32).map(at).collect(), &ticks)?;
        let states = kept.slows.iter().map(|slow| at(slow.frame)).collect();
        let states = columns::states(py, states, &kept.slows)?;
        let events = events.into_iter().map(|(frame, what)| (at(frame), what)).collect();
        Ok((ticks, states, events, PyBytes::new(py, &kept.line)))
    }
}

/// Voltages at the pins that a recording makes, a row a scan (8000 a second).
#[pyfunction]
#[pyo3(signature = (t_s, columns, recipe, seed))]
pub fn pins<'py>(
    py: Python<'py>,
    t_s: PyReadonlyArray1<'py, f64>,
    columns: Vec<(String, PyReadonlyArray1<'py, f64>)>,
    recipe: Option<&str>,
    seed: u64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let mut plant = plant(&recording(t_s, columns)?, recipe, seed)?;
    let scans = frames_in(plant.duration_s()) as usize * SCANS_PER_FRAME;
    let volts: Vec<Vec<f64>> = (0..scans).map(|_| plant.scan(MotorDrive::Coast).0.to_vec()).collect();
    Ok(PyArray2::from_vec2(py, &volts)?)
}

fn recording(
    t_s: PyReadonlyArray1<'_, f64>,
    columns: Vec<(String, PyReadonlyArray1<'_, f64>)>,
) -> PyResult<Recording> {
    let columns = columns.into_iter().map(|(name, values)| (name, values.as_array().to_vec())).collect();
    Recording::of("the samples", t_s.as_array().to_vec(), columns).map_err(refused)
}

fn plant(recording: &Recording, recipe: Option<&str>, seed: u64) -> PyResult<ReplayPlant> {
    let named = recipe.map(Recipe::asked).transpose().map_err(refused)?;
    ReplayPlant::of(recording, named.as_ref(), seed).map_err(refused)
}
