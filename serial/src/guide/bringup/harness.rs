//! The loop-back harness: two resistors and two capacitors lead the bridge's pins back to two film inputs, so that a board without
//! sensors measures its own outputs. The line may close only a hand whose force is known: a divider holds the quadrants at rest.

use std::time::Duration;

use tenax_hal_shim::channel::{PVDF, REFERENCE_MV};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::Up;

use super::Figure;
use super::noise::Levels;
use super::wire::{Stream, Wire};
use crate::guide::Say;

/// What has to be wired.
pub const HARNESS: &str = "PA8 through 10 kohm to PC2, PA9 through 10 kohm to PC3, each with 1 uF to ground; PC4 to 15 kohm from 3.3 V and 1 kohm to ground; no bridge.";

type Way = fn(Duty) -> MotorDrive;
/// Each output with the film input that it leads to.
const LOOPS: [(&str, Way, usize); 2] =
    [("closing", MotorDrive::Close, PVDF + 10), ("opening", MotorDrive::Open, PVDF + 11)];
const DUTIES: [u16; 4] = [200, 400, 600, 800];
/// Longer than the filter takes: 10 ms.
const SETTLES: Duration = Duration::from_millis(300);
const MEASURED: Duration = Duration::from_millis(400);
/// A mean is off by the resistors' ratio to the converter's input, its offset and the ports' voltage drop, mV.
const OFF_MV: f64 = 30.0;
/// A film moves when it is this far from where it was, samples: 20 mV. The filter rises by 100 in the first frame.
const MOVES: i32 = 100;
const RAW: Stream = Stream { raw: true, senses: false };

/// Drives each output at some duties and measures what comes back: its mean, and how many frames after the tick that drives.
pub fn harness(wire: &mut Wire<'_>, say: Say<'_>) -> anyhow::Result<Vec<Figure>> {
    let mut figures = Vec::new();
    for (name, way, input) in LOOPS {
        let mut worst_mv: f64 = 0.0;
        for permille in DUTIES {
            let drive = way(Duty::per_mille(permille));
            Levels::driven(wire, drive, SETTLES, say)?;
            let (mean_mv, _) = Levels::driven(wire, drive, MEASURED, say)?.of(input);
            let off_mv = (mean_mv - f64::from(REFERENCE_MV) * f64::from(permille) / 1e3).abs();
            // NaN, where nothing came, is the worst.
            worst_mv = if off_mv <= worst_mv { worst_mv } else { off_mv };
            wire.hear(SETTLES, RAW, &mut |_, _| Ok(false))?;
        }
        figures
            .push(Figure::told(format!("{name}: worst mean is off by"), worst_mv, "mV").within(0.0, OFF_MV));
        let late = delay(wire, way, input - PVDF, say)?;
        // What a tick decides is on the pin before the next frame ends.
        figures.push(
            Figure::told(format!("{name}: frames from a tick to its sample"), late, "").within(1.0, 2.0),
        );
    }
    Ok(figures)
}

/// Frames from the first tick that drives to the first sample that moves. NaN if either never comes.
fn delay(wire: &mut Wire<'_>, way: Way, film: usize, say: Say<'_>) -> anyhow::Result<f64> {
    wire.hear(SETTLES, RAW, &mut |_, _| Ok(false))?;
    let (mut driven, mut moved, mut rest) = (None::<u32>, None::<u32>, None::<i32>);
    wire.drive(way(Duty::FULL), SETTLES, RAW, say, &mut |_, message| {
        match message {
            Up::Slow(slow) if driven.is_none() => {
                let first = slow.ticks.iter().position(|tick| tick.drive != MotorDrive::Coast);
                // Its last tick is that of its frame.
                driven = first.map(|tick| slow.frame + 1 + tick as u32 - slow.ticks.len() as u32);
            }
            Up::Raw(raw) if moved.is_none() => {
                for frame in raw.frames().iter().filter(|frame| frame.valid) {
                    let sample = i32::from(frame.pvdf[film]);
                    let from = *rest.get_or_insert(sample);
                    if (sample - from).abs() > MOVES {
                        moved = moved.or(Some(frame.sequence));
                    }
                }
            }
            _ => {}
        }
        Ok(false)
    })?;
    Ok(match (driven, moved) {
        (Some(driven), Some(moved)) => f64::from(moved) - f64::from(driven),
        _ => f64::NAN,
    })
}
