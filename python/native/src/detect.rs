//! Each detector alone, on signals of anybody's sensors.

use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use tenax_hal_shim::channel::{ARRAY, ARRAY_COUNT, FRAMES_PER_SLOW_FRAME, PVDF_COUNT, SCANS_PER_FRAME};
use tenax_hal_shim::front_end::fsr_quadrants_n;
use tenax_hal_shim::wire::Forces;
use tenax_hal_shim::words::Code;
use tenax_logic::array::taxels::Taxels;
use tenax_logic::array::{Reading, ShippedDetector};
use tenax_logic::config::Config;
use tenax_logic::detectors::{Detector, Said, Sensed};
use tenax_logic::force::FrictionDetector;
use tenax_logic::force::sensor::forces;
use tenax_logic::hebbian::HebbianDetector;
use tenax_logic::photoelastic::Head;
use tenax_logic::store::record::{PAYLOAD_BYTES, Record};
use tenax_logic::strain::Gauges;
use tenax_logic::vibration::{Vibration, VibrationDetector};
use tenax_scene::plant::Pins;
use tenax_sim::replay::resample::Grid;

use crate::columns::{MV, put};

const SLOTS: usize = FRAMES_PER_SLOW_FRAME as usize;
/// Scans in a slow frame.
const SCANS: usize = SLOTS * SCANS_PER_FRAME;

type Table<'py> = PyResult<Bound<'py, PyDict>>;

/// A signal of `rate_hz` rows a second, on the scans' instants, 8000 a second.
fn drawn(values: Vec<f64>, rate_hz: f64) -> PyResult<Vec<f64>> {
    if values.len() < 2 || !values.iter().all(|value| value.is_finite()) || !(rate_hz > 0.0 && rate_hz < 1e9)
    {
        return Err(PyValueError::new_err("a signal has two rows or more, finite, and a rate in Hz"));
    }
    let t_s: Vec<f64> = (0..values.len()).map(|row| row as f64 / rate_hz).collect();
    let grid = Grid::new(rate_hz, 0.0, values.len() as f64 / rate_hz, 0.0, 0.0);
    Ok(grid.thin(&grid.draw(&t_s, &values)))
}

fn columns(array: &PyReadonlyArray2<'_, f64>, most: usize, rate_hz: f64) -> PyResult<Vec<Vec<f64>>> {
    let array = array.as_array();
    if !(1..=most).contains(&array.ncols()) {
        return Err(PyValueError::new_err(format!("1 to {most} columns, not {}", array.ncols())));
    }
    array.columns().into_iter().map(|column| drawn(column.to_vec(), rate_hz)).collect()
}

/// Samples (14 bits) of `count` channels from `first` on, as the converter would read these volts.
fn samples<const N: usize>(columns: &[Vec<f64>], first: usize, scans: std::ops::Range<usize>) -> [u16; N] {
    let mut sums = [0; N];
    for scan in scans {
        let mut pins = Pins::default();
        columns.iter().enumerate().for_each(|(n, column)| pins.0[first + n] = column[scan]);
        let codes = pins.codes();
        sums.iter_mut().zip(&codes[first..]).for_each(|(sum, code)| *sum += code);
    }
    sums
}

struct Sensors {
    vibration: Vibration,
    envelopes: [i32; PVDF_COUNT],
    strain: Gauges,
    taxels: Reading,
    head: Head,
}

impl Default for Sensors {
    fn default() -> Self {
        Self {
            vibration: Vibration::default(),
            envelopes: [0; PVDF_COUNT],
            strain: Gauges::default(),
            taxels: [None; ARRAY_COUNT],
            head: Head::default(),
        }
    }
}

impl Sensors {
    /// What a detector is given of them. `held`: the finger holds an object.
    fn sensed<'a>(&'a self, frame: u32, forces: Option<&'a Forces>, held: bool) -> Sensed<'a> {
        Sensed {
            frame,
            slot: (frame % u32::from(FRAMES_PER_SLOW_FRAME)) as u8,
            valid: true,
            vibration: self.vibration,
            envelopes: &self.envelopes,
            vibration_known: true,
            strain: &self.strain,
            forces,
            forces_are_new: forces.is_some(),
            taxels: &self.taxels,
            head: &self.head,
            unloaded: !held,
            grasp: held,
            noisy: self.vibration.impact,
            moves: false,
            wearer: false,
        }
    }
}

#[derive(Default)]
struct Told {
    time_s: Vec<f64>,
    slip: Vec<bool>,
    incipient: Vec<bool>,
    value: Vec<f64>,
}

impl Told {
    fn push(&mut self, time_s: f64, said: Said, value: f64) {
        self.time_s.push(time_s);
        self.slip.push(said.slip);
        self.incipient.push(said.incipient);
        self.value.push(value);
    }

    fn table(self, py: Python<'_>) -> Table<'_> {
        let table = PyDict::new(py);
        put(&table, "time_s", self.time_s)?;
        put(&table, "slip", self.slip)?;
        put(&table, "incipient", self.incipient)?;
        put(&table, "value", self.value)?;
        Ok(table)
    }
}

fn frame_s(frame: usize) -> f64 {
    tenax_sim::board::simulated::seconds_of(frame as u32 + 1)
}

fn config(s1_mv: Option<i32>, s2_permille: Option<i32>) -> PyResult<Config> {
    use tenax_logic::setting::SettingId;
    let mut config = Config::default();
    for (id, value) in [(SettingId::S1, s1_mv), (SettingId::S2, s2_permille)] {
        if let Some(value) = value {
            config.set(id, value).map_err(|range| {
                PyValueError::new_err(format!("a threshold of {value} is not within {range:?}"))
            })?;
        }
    }
    Ok(config)
}

/// S1 (Prosthesis, section 5) of films' volts: value is the loudest film's envelope, mV.
#[pyfunction]
#[pyo3(signature = (volts, rate_hz, s1_mv))]
pub fn s1<'py>(
    py: Python<'py>,
    volts: PyReadonlyArray2<'py, f64>,
    rate_hz: f64,
    s1_mv: Option<i32>,
) -> Table<'py> {
    let (config, films) = (config(s1_mv, None)?, columns(&volts, PVDF_COUNT, rate_hz)?);
    let (mut detector, mut told) = (VibrationDetector::default(), Told::default());
    for frame in 0..films[0].len() / SCANS_PER_FRAME {
        let scans = frame * SCANS_PER_FRAME..(frame + 1) * SCANS_PER_FRAME;
        let vibration = detector.process(&config.vibration, &samples(&films, 0, scans), None);
        if (frame + 1) % SLOTS == 0 {
            detector.learn_noise(&config.vibration, false);
        }
        told.push(frame_s(frame), Said::slip(vibration.s1), f64::from(vibration.level) * MV);
    }
    told.table(py)
}

/// S2 (Prosthesis, section 5) of normal force and shear in newtons, 80 times a second: value is Ft/Fn.
#[pyfunction]
#[pyo3(signature = (normal_n, shear_n, rate_hz, s2_permille))]
pub fn s2<'py>(
    py: Python<'py>,
    normal_n: PyReadonlyArray1<'py, f64>,
    shear_n: PyReadonlyArray1<'py, f64>,
    rate_hz: f64,
    s2_permille: Option<i32>,
) -> Table<'py> {
    let config = config(None, s2_permille)?.friction;
    let normal = drawn(normal_n.as_array().to_vec(), rate_hz)?;
    let shear = drawn(shear_n.as_array().to_vec(), rate_hz)?;
    let (mut detector, mut told) = (FrictionDetector::default(), Told::default());
    let (sensors, mut said) = (Sensors::default(), Said::NOTHING);
    for (n, (normal, shear)) in normal.iter().zip(&shear).skip(SCANS - 1).step_by(SCANS).enumerate() {
        let quadrants = fsr_quadrants_n(normal.max(0.0), *shear, 0.0);
        let forces = forces(quadrants.map(|newtons| (newtons * 1e3) as i32), config.loaded_mn);
        let frame = (n * SLOTS) as u32;
        said = detector.step(&config, &sensors.sensed(frame, Some(&forces), true)).unwrap_or(said);
        let ratio = detector.ratio_permille().map_or(f64::NAN, |permille| f64::from(permille) / 1e3);
        told.push(frame_s((n + 1) * SLOTS - 1), said, ratio);
    }
    told.table(py)
}

/// The MLP that ships (Bamshad 2023) on taxels' volts, 80 times a second: value is its confidence, 0 to 1.
#[pyfunction]
#[pyo3(signature = (volts, rate_hz))]
pub fn mlp<'py>(py: Python<'py>, volts: PyReadonlyArray2<'py, f64>, rate_hz: f64) -> Table<'py> {
    let taxels_v = columns(&volts, ARRAY_COUNT, rate_hz)?;
    let (mut taxels, mut detector, mut told) =
        (Taxels::default(), ShippedDetector::default(), Told::default());
    for cycle in 0..taxels_v[0].len() / SCANS {
        let last = (cycle + 1) * SCANS;
        let read: [u16; ARRAY_COUNT] = samples(&taxels_v, ARRAY, last - SCANS_PER_FRAME..last);
        read.iter().enumerate().take(taxels_v.len()).for_each(|(n, &sample)| _ = taxels.read(n, sample));
        let verdict = detector.push(taxels.reading());
        let (said, sure) = (Said::slip(verdict.slip), f64::from(verdict.confidence_permille) / 1e3);
        told.push(frame_s((cycle + 1) * SLOTS - 1), said, sure);
    }
    told.table(py)
}

/// The Hebbian network (Tada 2006) on films' and gauges' volts: value is output o1. Codes v1 and v2 of the teacher are 1, 0 or -1, a row
/// a picture, at `taught_s`; and what the network knows afterwards is given back, to be begun with.
#[pyfunction]
#[pyo3(signature = (films_v, strain_v, held, rate_hz, taught_s, codes, knows))]
#[expect(clippy::too_many_arguments, reason = "called by the package alone, which names them")]
pub fn hebbian<'py>(
    py: Python<'py>,
    films_v: PyReadonlyArray2<'py, f64>,
    strain_v: Option<PyReadonlyArray2<'py, f64>>,
    held: PyReadonlyArray1<'py, f64>,
    rate_hz: f64,
    taught_s: PyReadonlyArray1<'py, f64>,
    codes: PyReadonlyArray2<'py, i64>,
    knows: Option<&[u8]>,
) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyBytes>)> {
    let config = Config::default();
    let films = columns(&films_v, PVDF_COUNT, rate_hz)?;
    let strain = strain_v.map(|volts| columns(&volts, PVDF_COUNT, rate_hz)).transpose()?.unwrap_or_default();
    let held = drawn(held.as_array().to_vec(), rate_hz)?;
    let (mut detector, mut vibration) = (HebbianDetector::default(), VibrationDetector::default());
    if knows.is_some_and(|bytes| !detector.restore(bytes)) {
        return Err(PyValueError::new_err("these are no bytes of a network"));
    }
    let codes = codes.as_array();
    let mut lessons = taught_s.as_array().into_iter().copied().zip(codes.rows()).peekable();
    let (mut sensors, mut told, mut outputs) = (Sensors::default(), Told::default(), Vec::new());
    for frame in 0..films[0].len() / SCANS_PER_FRAME {
        let (scans, time_s) = (frame * SCANS_PER_FRAME..(frame + 1) * SCANS_PER_FRAME, frame_s(frame));
        let is_held = held[scans.start] >= 0.5;
        while let Some((_, row)) = lessons.next_if(|(at_s, _)| *at_s <= time_s) {
            let code = |n: usize| Code::from_sign(row.get(n).map_or(0, |code| code.signum() as i32));
            detector.teach(&config.hebbian, [code(0), code(1)], 0);
        }
        sensors.vibration = vibration.process(&config.vibration, &samples(&films, 0, scans.clone()), None);
        sensors.envelopes = *vibration.envelopes();
        let gauge = frame % SLOTS;
        if gauge < strain.len() {
            let read: [u16; PVDF_COUNT] = samples(&strain, tenax_hal_shim::channel::STRAIN, scans);
            sensors.strain.read(gauge, read[gauge], !is_held);
        }
        let said = detector.step(&config.hebbian, &sensors.sensed(frame as u32, None, is_held));
        told.push(time_s, said.unwrap_or_default(), f64::from(detector.outputs()[0]) / 128.0);
        outputs.push(f64::from(detector.outputs()[1]) / 128.0);
    }
    let record = Record::Network(detector.learned());
    let table = told.table(py)?;
    table.set_item("o2", PyArray1::from_vec(py, outputs))?;
    Ok((table, PyBytes::new(py, record.payload(&mut [0; PAYLOAD_BYTES]))))
}
