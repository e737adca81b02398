//! The bridge with a resistor instead of a motor: its current says whether it drives.

use std::time::{Duration, Instant};

use tenax_hal_shim::channel::{CHANNELS, MOTOR_CURRENT, SLOW_HZ, mv_from_sample};
use tenax_hal_shim::front_end::MOTOR_MV_PER_A;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::Up;

use super::wire::{Stream, Wire};
use super::{Asked, Figure};
use crate::guide::Say;

const SENSES: Stream = Stream { raw: false, senses: true };
const DUTY: Duty = Duty::per_mille(300);
/// Current that is surely one, and that is surely none, mA.
const DRIVEN_MA: f64 = 10.0;
const OFF_MA: f64 = 5.0;
/// Each way draws the same, but for so much, per cent.
const UNEQUAL_PERCENT: f64 = 20.0;
/// A silence of the board that is a halt.
const SILENCE: Duration = Duration::from_millis(300);
/// What the last command still drives after a halt: a quarter of a second.
const HELD: Duration = Duration::from_millis(400);
/// How long a person may take: the line may drive for 10 s in a row.
const PATIENCE: Duration = Duration::from_secs(6);
const BACK: Duration = Duration::from_secs(120);
/// Readings after a start that are averaged.
const READINGS: usize = SLOW_HZ as usize / 4;

/// The current in a message, mA above the live zero.
fn current_ma(message: &Up) -> Option<f64> {
    let Up::Senses(senses) = message else { return None };
    let mv = f64::from(mv_from_sample(senses.samples[MOTOR_CURRENT]));
    Some(1e3 * (mv - f64::from(CHANNELS[MOTOR_CURRENT].rest_mv)) / f64::from(MOTOR_MV_PER_A))
}

/// Mean of the last readings of a second, mA.
fn settled(heard: &[f64]) -> f64 {
    let last = &heard[heard.len().saturating_sub(READINGS)..];
    last.iter().sum::<f64>() / last.len() as f64
}

/// Drives both ways, and is interrupted while it drives: by reset, flashing, halt, the power.
pub(super) fn outputs(wire: &mut Wire<'_>, asked: &Asked, say: Say<'_>) -> anyhow::Result<Vec<Figure>> {
    let lasts = asked.lasts.unwrap_or(Duration::from_secs(1));
    let mut rest = Vec::new();
    wire.hear(lasts, SENSES, &mut |_, message| {
        rest.extend(current_ma(message));
        Ok(false)
    })?;
    let rest_ma = settled(&rest);
    let mut drawn = [f64::NAN; 2];
    for (drawn, way) in drawn.iter_mut().zip([MotorDrive::Close(DUTY), MotorDrive::Open(DUTY)]) {
        let mut heard = Vec::new();
        wire.drive(way, lasts, SENSES, say, &mut |_, message| {
            heard.extend(current_ma(message));
            Ok(false)
        })?;
        *drawn = settled(&heard) - rest_ma;
        wire.hear(lasts, SENSES, &mut |_, _| Ok(false))?;
    }
    let [close_ma, open_ma] = drawn;
    let unequal = 200.0 * (close_ma - open_ma).abs() / (close_ma + open_ma);
    let mut figures = vec![
        Figure::told("current at rest", rest_ma, "mA"),
        Figure::told("closing draws", close_ma, "mA").within(DRIVEN_MA, f64::INFINITY),
        Figure::told("opening draws", open_ma, "mA").within(DRIVEN_MA, f64::INFINITY),
        Figure::told("they differ by", unequal, "%").within(0.0, UNEQUAL_PERCENT),
    ];
    let times = asked.times.unwrap_or(4);
    for n in 1..=times {
        figures.push(interrupted(wire, &format!("{n} of {times}"), rest_ma, say)?);
    }
    Ok(figures)
}

/// The current after somebody has interrupted a board that drives.
fn interrupted(wire: &mut Wire<'_>, nth: &str, rest_ma: f64, say: Say<'_>) -> anyhow::Result<Figure> {
    say(&format!(
        "{nth}: it drives for 6 s. Reset it, flash it, halt it or cut its power; then let it run."
    ))?;
    let (mut heard, mut restarted) = (None::<Instant>, false);
    let mut is_interrupted = |came: Instant, message: &Up| {
        restarted = matches!(message, Up::Hello { .. });
        let is_halted = heard.is_some_and(|heard| came - heard > SILENCE);
        heard = Some(came);
        restarted || is_halted
    };
    let is_over = wire.drive(MotorDrive::Close(DUTY), PATIENCE, SENSES, say, &mut |came, message| {
        Ok(is_interrupted(came, message))
    })?;
    if !is_over {
        // It is still off, or nobody has done anything.
        wire.wait(BACK, "the board to be interrupted", SENSES, &mut |came, message| {
            Ok(is_interrupted(came, message))
        })?;
    }
    if !restarted {
        wire.hear(HELD, SENSES, &mut |_, _| Ok(false))?;
    }
    let mut after = Vec::new();
    wire.wait(BACK, "readings after it", SENSES, &mut |_, message| {
        after.extend(current_ma(message));
        Ok(after.len() >= READINGS)
    })?;
    let most = after.iter().map(|ma| (ma - rest_ma).abs()).fold(0.0, f64::max);
    let how = if restarted { "a start" } else { "a halt" };
    Ok(Figure::told(format!("{nth}: current after {how}"), most, "mA").within(0.0, OFF_MA))
}
