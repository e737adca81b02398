//! A world whose motor somebody else drives, 80 times a second.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use tenax_hal_shim::channel::{
    CHANNELS, FRAMES_PER_SLOW_FRAME, MOTOR_CURRENT, OPENING, PVDF_COUNT, RANK_SWITCH_A, RANK_SWITCH_B,
    SAMPLE_MAX, SCANS_PER_FRAME,
};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::frame::Scan;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::schedule::SCHEDULE;
use tenax_hal_shim::wire::Slow;
use tenax_hal_shim::words::DriveSource;
use tenax_scene::SceneFile;
use tenax_scene::drawn::{Drawn, Family, nth};
use tenax_scene::plant::Plant;
use tenax_scene::truth::Row;
use tenax_sim::board::Recorder;
use tenax_sim::board::kept::Set;
use tenax_sim::board::simulated::{Grips, Stepper, frames_in, seconds_of};
use tenax_sim::report::fate::Fate;
use tenax_sim::session;

use crate::columns::{self, MV, drive_of, signed};
use crate::fingertip::Settings;
use crate::refused;

const SLOTS: usize = FRAMES_PER_SLOW_FRAME as usize;
const SWITCHED: usize = CHANNELS.len() - PVDF_COUNT;

/// What the board's sensors and its logic said last.
#[derive(Default)]
struct Watch {
    scans: usize,
    /// Samples of the films in the slow frame so far or last, 14 bits.
    films: [[u16; PVDF_COUNT]; SLOTS],
    /// Last samples of the channels behind the switches, 14 bits.
    switched: [u16; SWITCHED],
    slow: Option<Slow>,
    /// Largest vibration since the last step, samples.
    vibration: u16,
}

impl Recorder for Watch {
    fn scan(&mut self, codes: &Scan, _drive: MotorDrive) {
        let (frame, first) = (self.scans / SCANS_PER_FRAME, self.scans.is_multiple_of(SCANS_PER_FRAME));
        self.scans += 1;
        let slot = &SCHEDULE[frame % SLOTS];
        for (film, code) in self.films[frame % SLOTS].iter_mut().zip(codes) {
            *film = if first { *code } else { *film + code };
        }
        for (channel, rank) in [(slot.switch_a, RANK_SWITCH_A), (slot.switch_b, RANK_SWITCH_B)] {
            if let Some(place) = channel.and_then(|channel| usize::from(channel).checked_sub(PVDF_COUNT)) {
                self.switched[place] = if first { codes[rank] } else { self.switched[place] + codes[rank] };
            }
        }
    }

    fn slow(&mut self, slow: &Slow) {
        self.vibration = slow.ticks.iter().map(|tick| tick.vibration).fold(self.vibration, u16::max);
        self.slow = Some(slow.clone());
    }
}

/// Name, least and most of each number of a conditioned observation.
pub fn observed() -> Vec<(String, f64, f64)> {
    let force = |name: &str, least: f64| (name.to_owned(), least, 200.0);
    let flag = |name: String| (name, 0.0, 1.0);
    let mut all = vec![("vibration_mv".to_owned(), 0.0, f64::from(SAMPLE_MAX) * MV)];
    all.extend(
        [("fn_n", -200.0), ("load_n", -200.0), ("fx_n", -200.0), ("fy_n", -200.0), ("ft_n", 0.0)]
            .map(|(name, least)| force(name, least)),
    );
    all.extend([("ratio".to_owned(), 0.0, 66.0), ("s2".to_owned(), 0.0, 66.0), force("margin_n", -200.0)]);
    all.extend([("flexor_mv".to_owned(), -3_300.0, 3_300.0), ("extensor_mv".to_owned(), -3_300.0, 3_300.0)]);
    all.push(flag("wearer_active".to_owned()));
    all.push(flag("force_known".to_owned()));
    all.extend([("o1".to_owned(), -1.0, 1.0), ("o2".to_owned(), -1.0, 1.0)]);
    all.extend([("opening_v".to_owned(), 0.0, 3.3), ("motor_current_v".to_owned(), 0.0, 3.3)]);
    all.push(("drive".to_owned(), -1.0, 1.0));
    all.extend(DetectorId::ALL.map(|id| flag(format!("{}_says", id.name()))));
    all
}

pub fn nth_drawn(family: Option<&str>, seed: u64, n: u32) -> PyResult<Drawn> {
    let family = family.map(str::parse::<Family>).transpose();
    Ok(nth(family.map_err(|what| refused(anyhow::anyhow!(what)))?, seed, n))
}

#[pyclass]
pub struct World {
    file: SceneFile,
    plant: Set<tenax_scene::World>,
    board: Stepper,
    watch: Watch,
    reflex: bool,
    frames: u32,
    until: u32,
    last: Option<Row>,
}

#[pymethods]
impl World {
    /// A scene that ships, or a scene file. `reflex`: the firmware's reflex acts, and a duty is added to its drive.
    #[new]
    fn new(scene: &str, seed: u64, reflex: bool, settings: Settings) -> PyResult<Self> {
        Self::of(session::load_scene(scene).map_err(refused)?, seed, reflex, &settings)
    }

    /// World `n` of `tenax sweep --drawn --seed SEED`, of a family or of each in turn.
    #[staticmethod]
    #[pyo3(signature = (family, seed, n, reflex, settings))]
    fn drawn(family: Option<&str>, seed: u64, n: u32, reflex: bool, settings: Settings) -> PyResult<Self> {
        let drawn = nth_drawn(family, seed, n)?;
        Self::of(drawn.scene().map_err(refused)?, drawn.noise_seed, reflex, &settings)
    }

    /// Goes on by slow frames of 12.5 ms under a duty. False: the scene is over.
    fn step(&mut self, py: Python<'_>, duty: f64, slow_frames: u32) -> bool {
        py.detach(|| self.advance(drive_of(duty), slow_frames * u32::from(FRAMES_PER_SLOW_FRAME)))
    }

    /// Conditioned readings, in the order of `OBSERVED`; 0 for what is not known.
    fn observation<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        let volts = |channel: usize| f64::from(self.watch.switched[channel - PVDF_COUNT]) * MV / 1e3;
        let fingertip = &self.board.device.fingertip;
        let tick = fingertip.last_tick().unwrap_or_default();
        let mut all = vec![f64::from(self.watch.vibration) * MV];
        let known = |(_, value): (&str, f64)| if value.is_nan() { 0.0 } else { value };
        match &self.watch.slow {
            Some(slow) => all.extend(columns::quantities(slow).map(known)),
            None => all.extend([0.0; 11]),
        }
        all.push(f64::from(u8::from(fingertip.forces().is_some())));
        all.extend(tick.outputs.map(|output| f64::from(output) / 128.0));
        all.extend([volts(OPENING), volts(MOTOR_CURRENT), signed(self.board.drive())]);
        all.extend(DetectorId::ALL.map(|id| f64::from(u8::from(tick.said.contains(id)))));
        PyArray1::from_iter(py, all.into_iter().map(|value| value as f32))
    }

    /// Volts at the pins: the films in each of the last 25 frames, then the channels behind the switches.
    fn raw<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        let samples = self.watch.films.iter().flatten().chain(&self.watch.switched);
        PyArray1::from_iter(py, samples.map(|&sample| (f64::from(sample) * MV / 1e3) as f32))
    }

    /// What really happens: time (s), newton-seconds beyond need and millimetres slid so far, grip and need (N), kept.
    fn truth(&self) -> (f64, f64, f64, f64, f64, bool) {
        let truth = self.plant.plant.truth();
        let [grip_n, needed_n] = self.last.as_ref().map_or([0.0; 2], |row| [row.grip_n, row.needed_n]);
        let kept = Fate::of(truth, &self.file).kept();
        (seconds_of(self.frames), truth.beyond_need_ns, truth.slip_distance_mm, grip_n, needed_n, kept)
    }

    /// Scores so far, as a report of `tenax run` has them.
    fn scores<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let fate = Fate::of(self.plant.plant.truth(), &self.file);
        let scores = PyDict::new(py);
        scores.set_item("kept", fate.kept())?;
        scores.set_item("slid_mm", fate.distance_mm)?;
        scores.set_item("peak_n", fate.peak_grip_n)?;
        scores.set_item("mean_n", fate.mean_grip_n)?;
        scores.set_item("needed_n", fate.needed_force_n)?;
        scores.set_item("beyond_need_n", fate.beyond_need_n)?;
        Ok(scores)
    }

    /// Micro onset, macro onset and end (s, infinite while it slides), way (mm), and whether it was meant, of every slip so far.
    fn slips(&self) -> Vec<(f64, f64, f64, f64, bool)> {
        let slips = self.plant.plant.truth().slips.iter();
        slips
            .map(|slip| {
                let end_s = slip.end_s.unwrap_or(f64::INFINITY);
                (slip.micro_onset_s, slip.macro_onset_s, end_s, slip.distance_mm, slip.meant)
            })
            .collect()
    }

    #[getter]
    fn name(&self) -> &str {
        &self.file.name
    }

    #[getter]
    fn duration_s(&self) -> f64 {
        seconds_of(self.until)
    }
}

impl World {
    fn of(file: SceneFile, seed: u64, reflex: bool, settings: &Settings) -> PyResult<Self> {
        let plant = Set::new(tenax_scene::World::new(&file, seed), settings).map_err(refused)?;
        let detectors = if reflex { DetectorSet::ALL } else { DetectorSet::NONE };
        let board = Stepper::new(&plant, Grips::Reflex(detectors), &mut ());
        let until = frames_in(plant.duration_s());
        let watch = Watch::default();
        Ok(Self { file, plant, board, watch, reflex, frames: 0, until, last: None })
    }

    fn advance(&mut self, asked: MotorDrive, frames: u32) -> bool {
        self.watch.vibration = 0;
        for _ in 0..frames.min(self.until - self.frames) {
            let reflex = self.reflex;
            let goes_on =
                self.board.frame_with(&mut self.plant, &mut self.watch, &mut |own, fingertip, _| {
                    let source = fingertip.last_tick().unwrap_or_default().source;
                    let is_reflex = reflex && source == DriveSource::Reflex;
                    match own {
                        // The wearer comes first.
                        _ if fingertip.wearer_active() || asked == MotorDrive::Coast => own,
                        MotorDrive::Coast => asked,
                        _ if is_reflex => drive_of((signed(own) + signed(asked)).clamp(-1.0, 1.0)),
                        _ => own,
                    }
                });
            self.frames += 1;
            if !goes_on {
                self.until = self.frames;
            }
        }
        if let Some(row) = self.plant.plant.take_trace().next_back() {
            self.last = Some(row);
        }
        self.frames < self.until
    }
}
