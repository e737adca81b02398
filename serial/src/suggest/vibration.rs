//! S1: above what the films say while nothing happens, below what they say while something slips.

use tenax_hal_shim::channel::mv_from_sample;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::Slow;
use tenax_logic::setting::SettingId;

use super::{Suggestion, seconds, usual};
use crate::quantile::not_exceeded;

/// Slow frames after the motor has last run in which its gear is still heard: 0.3 s.
const RINGS: usize = 24;
/// Slow frames of quiet that are enough: three seconds.
const ENOUGH: usize = 240;
/// Of the quietest: how far S1 stays above what is usual in quiet.
const ABOVE_QUIET: f64 = 2.5;
/// What is this much above quiet is an event, not noise.
const EVENT: f64 = 4.0;

pub fn suggest(slows: &[Slow]) -> Result<Suggestion, String> {
    let loudest = |slow: &Slow| {
        f64::from(mv_from_sample(slow.ticks.iter().map(|tick| tick.vibration).max().unwrap_or(0)))
    };
    let (mut rings, mut quiet, mut slips) = (0, Vec::new(), Vec::new());
    let mut slip: Option<f64> = None;
    for slow in slows {
        let moved = slow.ticks.iter().any(|tick| tick.drive != MotorDrive::Coast);
        rings = if moved { RINGS } else { rings.saturating_sub(1) };
        // What the reflex answered is one event until it is over.
        let acted = slow.ticks.iter().any(|tick| !tick.acted.is_empty());
        slip = match (slip, acted || rings > 0) {
            (Some(most), true) => Some(most),
            (None, true) if acted => Some(loudest(slow)),
            (Some(most), false) => {
                slips.push(most);
                None
            }
            (None, _) => None,
        };
        if rings == 0 && !slow.wearer_active {
            quiet.push(loudest(slow));
        }
    }
    if quiet.len() < ENOUGH {
        return Err(format!(
            "s1-mv: only {:.1} s in which neither motor nor muscles were active; 3 s are enough",
            seconds(quiet.len())
        ));
    }
    let (median, most) = usual(&quiet).unwrap_or_default();
    let floor = ABOVE_QUIET * most.max(1.0);
    slips.retain(|&slip| slip > EVENT * most);
    let quietly = format!("{:.0} s of quiet: {median:.0} mV, up to {most:.0} mV usual", seconds(quiet.len()));
    Ok(match not_exceeded(slips.iter().copied(), 0.1) {
        // Half way between both, as ratios go.
        Some(slip) => Suggestion::new(
            SettingId::S1,
            (most * slip).sqrt().max(floor).min(slip / 2.0),
            format!(
                "{quietly}; slips that were answered: {}, of {slip:.0} mV and more; between both",
                slips.len()
            ),
        ),
        // How quiet slip may be is only heard while something slips: noise alone can raise S1, never lower it.
        None if floor <= f64::from(SettingId::S1.row().default) => {
            return Err(format!(
                "s1-mv: {quietly}, far enough below the default; let something slip to choose it better"
            ));
        }
        None => Suggestion::new(
            SettingId::S1,
            floor,
            format!(
                "{quietly}; no slip was answered: {ABOVE_QUIET} times what is usual, the least that is safe from noise"
            ),
        ),
    })
}
