//! What a run says, as columns of a table.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use tenax_hal_shim::channel::{REFERENCE_MV, SAMPLE_MAX};
use tenax_hal_shim::detector::{DetectorHealth, DetectorId, Evidence};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{Slow, TickRecord};
use tenax_hal_shim::words::GripMode;
use tenax_sim::board::Recorder;

/// Millivolts a 14-bit sample, as `tenax.MV`: the converter's reference over 16 384 steps.
pub const MV: f64 = REFERENCE_MV as f64 / (SAMPLE_MAX as f64 + 4.0);

/// -1 opens, 1 closes, both with the whole supply.
pub fn signed(drive: MotorDrive) -> f64 {
    f64::from(drive.signed_permille()) / 1e3
}

/// The nearest per mille; 0 and what is no number coast.
pub fn drive_of(duty: f64) -> MotorDrive {
    let permille = (duty.abs().min(1.0) * 1e3).round() as u16;
    match permille {
        0 => MotorDrive::Coast,
        _ if duty > 0.0 => MotorDrive::Close(Duty::per_mille(permille)),
        _ => MotorDrive::Open(Duty::per_mille(permille)),
    }
}

/// The recorder that keeps the line and the slow frames.
#[derive(Default)]
pub struct Kept {
    pub line: Vec<u8>,
    pub slows: Vec<Slow>,
}

impl Recorder for Kept {
    fn slow(&mut self, slow: &Slow) {
        self.slows.push(slow.clone());
    }

    fn line(&mut self, bytes: &[u8]) {
        self.line.extend_from_slice(bytes);
    }
}

pub fn put<T: numpy::Element>(table: &Bound<'_, PyDict>, name: &str, values: Vec<T>) -> PyResult<()> {
    table.set_item(name, PyArray1::from_vec(table.py(), values))
}

/// Columns of ticks, each with the mode after it.
pub fn ticks<'py>(
    py: Python<'py>,
    time_s: Vec<f64>,
    ticks: &[(TickRecord, GripMode)],
) -> PyResult<Bound<'py, PyDict>> {
    fn column<T>(ticks: &[(TickRecord, GripMode)], value: impl Fn(&TickRecord) -> T) -> Vec<T> {
        ticks.iter().map(|(tick, _)| value(tick)).collect()
    }
    let table = PyDict::new(py);
    put(&table, "time_s", time_s)?;
    put(&table, "vibration_mv", column(ticks, |tick| f64::from(tick.vibration) * MV))?;
    put(&table, "o1", column(ticks, |tick| f64::from(tick.outputs[0]) / 128.0))?;
    put(&table, "o2", column(ticks, |tick| f64::from(tick.outputs[1]) / 128.0))?;
    put(&table, "drive", column(ticks, |tick| signed(tick.drive)))?;
    put(&table, "source", column(ticks, |tick| tick.source as u8))?;
    put(&table, "said", column(ticks, |tick| tick.said.bits()))?;
    put(&table, "believed", column(ticks, |tick| tick.believed.bits()))?;
    put(&table, "acted", column(ticks, |tick| tick.acted.bits()))?;
    put(&table, "mode", ticks.iter().map(|(_, mode)| *mode as u8).collect())?;
    Ok(table)
}

fn evidence(slow: &Slow, id: DetectorId) -> Option<&Evidence> {
    slow.evidence.iter().find(|(own, _)| *own == id).map(|(_, evidence)| evidence)
}

/// Quantities of a slow frame that may be unknown (NaN): name and value.
pub fn quantities(slow: &Slow) -> [(&'static str, f64); 11] {
    let n = |mn: Option<i32>| mn.map_or(f64::NAN, |mn| f64::from(mn) / 1e3);
    let mv = |mv: Option<i16>| mv.map_or(f64::NAN, f64::from);
    let forces = slow.forces.as_ref();
    let ratio = forces.and_then(|forces| forces.ratio_permille).map(i32::from);
    [
        ("fn_n", n(forces.map(|forces| forces.fn_mn))),
        ("load_n", n(forces.map(|forces| forces.load_mn))),
        ("fx_n", n(forces.map(|forces| forces.fx_mn))),
        ("fy_n", n(forces.map(|forces| forces.fy_mn))),
        ("ft_n", n(forces.map(|forces| forces.ft_mn))),
        ("ratio", n(ratio)),
        ("s2", f64::from(slow.s2_permille) / 1e3),
        ("margin_n", n(forces.and_then(|forces| forces.margin_mn(slow.s2_permille)))),
        ("flexor_mv", mv(slow.flexor_mv)),
        ("extensor_mv", mv(slow.extensor_mv)),
        ("wearer_active", f64::from(u8::from(slow.wearer_active))),
    ]
}

/// Columns of slow frames. Of each detector: what it says, its confidence, the number that it compares and its health.
pub fn states<'py>(py: Python<'py>, time_s: Vec<f64>, slows: &[Slow]) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    put(&table, "time_s", time_s)?;
    put(&table, "mode", slows.iter().map(|slow| slow.mode as u8).collect())?;
    let rows: Vec<_> = slows.iter().map(quantities).collect();
    for (n, (name, _)) in rows.first().into_iter().flatten().enumerate() {
        put(&table, name, rows.iter().map(|row| row[n].1).collect())?;
    }
    for id in DetectorId::ALL.into_iter().filter(|&id| slows.iter().any(|slow| evidence(slow, id).is_some()))
    {
        let all = || slows.iter().map(|slow| evidence(slow, id).copied().unwrap_or_default());
        let column = |what: &str| format!("{}_{what}", id.name());
        put(&table, &column("slip"), all().map(|own| own.slip).collect())?;
        put(&table, &column("incipient"), all().map(|own| own.incipient).collect())?;
        put(
            &table,
            &column("confidence"),
            all().map(|own| f64::from(own.confidence_permille) / 1e3).collect(),
        )?;
        put(&table, &column("raw"), all().map(|own| own.raw).collect())?;
        put(&table, &column("works"), all().map(|own| own.health == DetectorHealth::Working).collect())?;
    }
    Ok(table)
}
