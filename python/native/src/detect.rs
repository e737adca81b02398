//! Each detector alone, on signals of anybody's sensors.

use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use tenax_hal_shim::channel::{
    ARRAY, ARRAY_COUNT, CHANNELS, FRAME_HZ, FRAMES_PER_SLOW_FRAME, HEAD, PVDF, PVDF_COUNT, SAMPLE_MAX,
    SCANS_PER_FRAME, SLOW_HZ, STRAIN, STRAIN_COUNT, sample_from_mv,
};
use tenax_hal_shim::front_end::fsr_quadrants_n;
use tenax_hal_shim::wire::Forces;
use tenax_hal_shim::words::Code;
use tenax_logic::array::shipped::MODEL;
use tenax_logic::array::taxels::Taxels;
use tenax_logic::array::{FEATURES, Preprocessor, PreprocessorConfig, Reading, ShippedDetector};
use tenax_logic::config::Config;
use tenax_logic::detectors::{Detector, Said, Sensed};
use tenax_logic::force::FrictionDetector;
use tenax_logic::force::sensor::forces;
use tenax_logic::hebbian::HebbianDetector;
use tenax_logic::photoelastic::track::Hints;
use tenax_logic::photoelastic::{Head, HeadConfig, PhotoelasticDetector};
use tenax_logic::store::record::{PAYLOAD_BYTES, Record};
use tenax_logic::strain::Gauges;
use tenax_logic::vibration::{Vibration, VibrationDetector};
use tenax_sim::board::kept::config_of;

use crate::columns::{MV, put};
use crate::fingertip::Settings;
use crate::refused;

const SLOTS: usize = FRAMES_PER_SLOW_FRAME as usize;

type Table<'py> = PyResult<Bound<'py, PyDict>>;

/// A signal of `rate_hz` rows a second at `own_hz`: along straight lines between rows; of a faster one, the mean of four instants, as the
/// board takes four scans.
fn drawn(values: &[f64], rate_hz: f64, own_hz: u32) -> PyResult<Vec<f64>> {
    if values.len() < 2 || !values.iter().all(|value| value.is_finite()) || !(1e-3..1e9).contains(&rate_hz) {
        return Err(PyValueError::new_err("a signal has two rows or more, finite, and a rate in Hz"));
    }
    let rows = rate_hz / f64::from(own_hz);
    let instants = if rows > 1.0 { SCANS_PER_FRAME } else { 1 };
    let at = |row: f64| {
        let (before, part) = ((row as usize).min(values.len() - 1), row.fract());
        let after = values[(before + 1).min(values.len() - 1)];
        values[before] + part * (after - values[before])
    };
    let mean = |n: usize| {
        let step = |k: usize| at((n as f64 + k as f64 / instants as f64) * rows);
        (0..instants).map(step).sum::<f64>() / instants as f64
    };
    Ok((0..(values.len() as f64 / rows) as usize).map(mean).collect())
}

fn columns(
    array: &PyReadonlyArray2<'_, f64>,
    most: usize,
    rate_hz: f64,
    own_hz: u32,
) -> PyResult<Vec<Vec<f64>>> {
    let array = array.as_array();
    if !(1..=most).contains(&array.ncols()) {
        return Err(PyValueError::new_err(format!("1 to {most} columns, not {}", array.ncols())));
    }
    array.columns().into_iter().map(|column| drawn(&column.to_vec(), rate_hz, own_hz)).collect()
}

/// Samples (14 bits) of a row of volts; of columns that are not there, what their pins have at rest.
fn samples<const N: usize>(columns: &[Vec<f64>], first: usize, row: usize) -> [u16; N] {
    std::array::from_fn(|n| match columns.get(n).and_then(|column| column.get(row).or(column.last())) {
        Some(volts) => (volts * 1e3 / MV).round().clamp(0.0, f64::from(SAMPLE_MAX)) as u16,
        None => sample_from_mv(CHANNELS[first + n].rest_mv),
    })
}

#[derive(Default)]
struct Sensors {
    vibration: Vibration,
    envelopes: [i32; PVDF_COUNT],
    strain: Gauges,
    taxels: Reading,
    head: Head,
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

/// Decisions as columns: in each frame what a detector says, and the number that it compares.
fn table<'py>(
    py: Python<'py>,
    frames: impl IntoIterator<Item = usize>,
    mut decide: impl FnMut(usize) -> (Said, f64),
) -> Table<'py> {
    let (mut times, mut slips, mut incipient, mut values) = (vec![], vec![], vec![], vec![]);
    for frame in frames {
        let (said, value) = decide(frame);
        times.push(frame_s(frame));
        slips.push(said.slip);
        incipient.push(said.incipient);
        values.push(value);
    }
    let table = PyDict::new(py);
    put(&table, "time_s", times)?;
    put(&table, "slip", slips)?;
    put(&table, "incipient", incipient)?;
    put(&table, "value", values)?;
    Ok(table)
}

/// The last frame of each slow frame.
fn slow_frames(count: usize) -> impl Iterator<Item = usize> {
    (1..=count).map(|n| n * SLOTS - 1)
}

fn frame_s(frame: usize) -> f64 {
    tenax_sim::board::simulated::seconds_of(frame as u32 + 1)
}

/// S1 (Prosthesis, section 5) of films' volts: value is the loudest film's envelope, mV.
#[pyfunction]
pub fn s1<'py>(
    py: Python<'py>,
    volts: PyReadonlyArray2<'py, f64>,
    rate_hz: f64,
    settings: Settings,
) -> Table<'py> {
    let (config, films) =
        (config_of(&settings).map_err(refused)?, columns(&volts, PVDF_COUNT, rate_hz, FRAME_HZ)?);
    let mut detector = VibrationDetector::default();
    table(py, 0..films[0].len(), |frame| {
        let vibration = detector.process(&config.vibration, &samples(&films, PVDF, frame), None);
        if (frame + 1) % SLOTS == 0 {
            detector.learn_noise(&config.vibration, false);
        }
        (Said::slip(vibration.s1), f64::from(vibration.level) * MV)
    })
}

/// S2 (Prosthesis, section 5) of normal force and shear in newtons, 80 times a second: value is Ft/Fn.
#[pyfunction]
pub fn s2<'py>(
    py: Python<'py>,
    normal_n: PyReadonlyArray1<'py, f64>,
    shear_n: PyReadonlyArray1<'py, f64>,
    rate_hz: f64,
    settings: Settings,
) -> Table<'py> {
    let config = config_of(&settings).map_err(refused)?.friction;
    let normal = drawn(&normal_n.as_array().to_vec(), rate_hz, SLOW_HZ)?;
    let shear = drawn(&shear_n.as_array().to_vec(), rate_hz, SLOW_HZ)?;
    let (mut detector, mut said, sensors) = (FrictionDetector::default(), Said::NOTHING, Sensors::default());
    let mut forces_n = normal.iter().zip(&shear);
    table(py, slow_frames(normal.len().min(shear.len())), |frame| {
        let (normal, shear) = forces_n.next().unwrap_or((&0.0, &0.0));
        let quadrants = fsr_quadrants_n(normal.max(0.0), *shear, 0.0);
        let forces = forces(quadrants.map(|newtons| (newtons * 1e3) as i32), config.loaded_mn);
        let begins = (frame + 1 - SLOTS) as u32;
        said = detector.step(&config, &sensors.sensed(begins, Some(&forces), true)).unwrap_or(said);
        let ratio = detector.ratio_permille().map_or(f64::NAN, |permille| f64::from(permille) / 1e3);
        (said, ratio)
    })
}

fn readings(taxels_v: &[Vec<f64>]) -> impl Iterator<Item = Reading> {
    let mut taxels = Taxels::default();
    (0..taxels_v[0].len()).map(move |row| {
        let read: [u16; ARRAY_COUNT] = samples(taxels_v, ARRAY, row);
        read.iter().enumerate().take(taxels_v.len()).for_each(|(n, &sample)| _ = taxels.read(n, sample));
        *taxels.reading()
    })
}

/// Features of taxels' volts, as the firmware's network gets them, a row a slow frame; 0 until the windows are full. `others`: a lag, and
/// the knees of covariances, bins and structure functions, in place of the shipped network's.
#[pyfunction]
#[pyo3(signature = (volts, rate_hz, others=None))]
pub fn features<'py>(
    py: Python<'py>,
    volts: PyReadonlyArray2<'py, f64>,
    rate_hz: f64,
    others: Option<(u8, u32, u32, u32)>,
) -> PyResult<Bound<'py, PyArray2<i16>>> {
    let taxels_v = columns(&volts, ARRAY_COUNT, rate_hz, SLOW_HZ)?;
    let mut config = MODEL.preprocessor;
    if let Some((lag, covariance_knee, spectrum_knee, structure_knee)) = others {
        config = PreprocessorConfig { lag, covariance_knee, spectrum_knee, structure_knee, ..config };
    }
    let mut preprocessor = Preprocessor::new(config);
    let rows: Vec<Vec<i16>> = readings(&taxels_v)
        .map(|reading| preprocessor.push(&reading).map_or(vec![0; FEATURES], |features| features.to_vec()))
        .collect();
    Ok(PyArray2::from_vec2(py, &rows)?)
}

/// A photoelastic head's flicker (Dubey 2006) on its volts: value is the ac envelope, mV.
#[pyfunction]
pub fn photoelastic<'py>(
    py: Python<'py>,
    volts: PyReadonlyArray1<'py, f64>,
    rate_hz: f64,
    settings: Settings,
) -> Table<'py> {
    let config = HeadConfig { fitted: true, ..config_of(&settings).map_err(refused)?.head };
    let light = [drawn(&volts.as_array().to_vec(), rate_hz, FRAME_HZ)?];
    let (mut detector, mut sensors) = (PhotoelasticDetector::default(), Sensors::default());
    table(py, 0..light[0].len(), |frame| {
        let [sample] = samples(&light, HEAD, frame);
        sensors.head.process(&config, sample);
        if (frame + 1) % SLOTS == 0 {
            sensors.head.cycle(&config, Hints { unloaded: false, force_mn: None });
        }
        let said = detector.step(&config, &sensors.sensed(frame as u32, None, true));
        (said.unwrap_or_default(), f64::from(sensors.head.level()) * MV)
    })
}

/// The MLP that ships (Bamshad 2023) on taxels' volts, 80 times a second: value is its confidence, 0 to 1.
#[pyfunction]
pub fn mlp<'py>(py: Python<'py>, volts: PyReadonlyArray2<'py, f64>, rate_hz: f64) -> Table<'py> {
    let taxels_v = columns(&volts, ARRAY_COUNT, rate_hz, SLOW_HZ)?;
    let (mut detector, mut readings) = (ShippedDetector::default(), readings(&taxels_v));
    table(py, slow_frames(taxels_v[0].len()), |_| {
        let verdict = detector.push(&readings.next().unwrap_or_default());
        (Said::slip(verdict.slip), f64::from(verdict.confidence_permille) / 1e3)
    })
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
    let films = columns(&films_v, PVDF_COUNT, rate_hz, FRAME_HZ)?;
    let strain = strain_v.map(|volts| columns(&volts, STRAIN_COUNT, rate_hz, FRAME_HZ)).transpose()?;
    let strain = strain.unwrap_or_default();
    let held = drawn(&held.as_array().to_vec(), rate_hz, FRAME_HZ)?;
    let (mut detector, mut vibration) = (HebbianDetector::default(), VibrationDetector::default());
    if knows.is_some_and(|bytes| !detector.restore(bytes)) {
        return Err(PyValueError::new_err("these are no bytes of a network"));
    }
    let codes = codes.as_array();
    let mut lessons = taught_s.as_array().into_iter().copied().zip(codes.rows()).peekable();
    let (mut sensors, mut outputs) = (Sensors::default(), Vec::new());
    let told = table(py, 0..held.len().min(films[0].len()), |frame| {
        let is_held = held[frame] >= 0.5;
        while let Some((_, row)) = lessons.next_if(|(at_s, _)| *at_s <= frame_s(frame)) {
            let code = |n: usize| Code::from_sign(row.get(n).map_or(0, |code| code.signum() as i32));
            detector.teach(&config.hebbian, [code(0), code(1)], 0);
        }
        sensors.vibration = vibration.process(&config.vibration, &samples(&films, PVDF, frame), None);
        sensors.envelopes = *vibration.envelopes();
        let gauge = frame % SLOTS;
        if gauge < strain.len() {
            let read: [u16; STRAIN_COUNT] = samples(&strain, STRAIN, frame);
            sensors.strain.read(gauge, read[gauge], !is_held);
        }
        let said = detector.step(&config.hebbian, &sensors.sensed(frame as u32, None, is_held));
        let [o1, o2, ..] = detector.outputs().map(|output| f64::from(output) / 128.0);
        outputs.push(o2);
        (said.unwrap_or_default(), o1)
    })?;
    let record = Record::Network(detector.learned());
    told.set_item("o2", PyArray1::from_vec(py, outputs))?;
    Ok((told, PyBytes::new(py, record.payload(&mut [0; PAYLOAD_BYTES]))))
}
