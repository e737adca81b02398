//! The board's clock, its ticks and its line.

use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::wire::{Answer, Counters, Down, EventKind, Up};
use tenax_hal_shim::words::Fault;

use super::wire::{Stream, Wire};
use super::{Asked, Figure};
use crate::guide::Say;
use crate::quantile::not_exceeded;

/// What the crystal and the PC's clock may be off together, millionths; the chip's own oscillator is off by thousands.
const CLOCK_PPM: f64 = 200.0;
/// The longest that a frame may take control, us: a frame is 500, and the select lines have to settle.
const CONTROL_US: f64 = 400.0;
/// A frame in cycles of the core, and in us.
const FRAME_CYCLES: f64 = 50_000.0;
const FRAME_US: f64 = 500.0;
const ALL: Stream = Stream { raw: true, senses: true };
/// A command's answer is waited for so long.
const PATIENCE: Duration = Duration::from_secs(1);

const fn is_lost_clock(message: &Up) -> bool {
    matches!(message, Up::Event(event) if matches!(event.kind, EventKind::Fault(Fault::CrystalLost)))
}

/// How many millionths the board is faster than the PC, and how much later than the earliest each message came, s: each of
/// its frames has a time of its own, and the line delays it by at least the same.
fn drift(heard: &[(f64, f64)]) -> Option<(f64, Vec<f64>)> {
    let quarter = heard.len() / 4;
    let earliest = |part: &[(f64, f64)]| {
        part.iter().map(|&(came_s, is_s)| (is_s, came_s - is_s)).min_by(|a, b| a.1.total_cmp(&b.1))
    };
    let (first, last) = (earliest(heard.get(..quarter)?)?, earliest(heard.get(heard.len() - quarter..)?)?);
    let slope = (last.1 - first.1) / (last.0 - first.0);
    let late = heard.iter().map(|&(came_s, is_s)| came_s - is_s - first.1 - slope * (is_s - first.0));
    Some((-1e6 * slope, late.collect()))
}

/// The board's clock beside the PC's.
pub(super) fn clock(wire: &mut Wire<'_>, asked: &Asked, _: Say<'_>) -> anyhow::Result<Vec<Figure>> {
    let (began, mut heard, mut lost) = (Instant::now(), Vec::new(), 0_u32);
    wire.hear(asked.lasts.unwrap_or(Duration::from_secs(60)), Stream::default(), &mut |came, message| {
        lost += u32::from(is_lost_clock(message));
        match message {
            Up::Hello { .. } if !heard.is_empty() => bail!("the board has started anew: begin again"),
            Up::Slow(slow) => {
                let is_s = f64::from(slow.frame) / f64::from(FRAME_HZ);
                heard.push(((came - began).as_secs_f64(), is_s));
            }
            _ => {}
        }
        Ok(false)
    })?;
    let (ppm, late) = drift(&heard).context("too few messages for a clock")?;
    Ok(vec![
        Figure::told("board's clock beside this computer's", ppm, "ppm").within(-CLOCK_PPM, CLOCK_PPM),
        Figure::none("crystal lost", lost),
        Figure::told(
            "slow frames come late by, 99 %",
            1e3 * not_exceeded(late, 0.99).unwrap_or(f64::NAN),
            "ms",
        ),
    ])
}

/// Counters, the first and the last, and what they say of the ticks between.
#[derive(Default)]
struct Counted {
    first: Option<Counters>,
    last: Counters,
    permille: Vec<f64>,
    starts: u32,
}

impl Counted {
    fn take(&mut self, message: &Up) {
        match message {
            Up::Hello { .. } => self.starts += 1,
            Up::Counters(counters) => {
                self.first.get_or_insert(*counters);
                self.last = *counters;
                self.permille.push(counters.control_permille.into());
            }
            _ => {}
        }
    }

    fn more(&self, of: fn(&Counters) -> u32) -> f64 {
        let first = self.first.unwrap_or_default();
        f64::from(of(&self.last).saturating_sub(of(&first)))
    }

    fn figures(&self) -> Vec<Figure> {
        let share = self.permille.iter().sum::<f64>() / self.permille.len() as f64 / 1e3;
        vec![
            Figure::told("frames taken", self.more(|all| all.frames), "").within(1.0, f64::INFINITY),
            Figure::none("frames lost", self.more(|all| all.frames_lost)),
            Figure::none("overruns", self.more(|all| all.overruns)),
            Figure::none("restarts", self.starts),
            Figure::told("ticks late", self.more(|all| all.ticks_late), ""),
            Figure::told("longest that a frame took control", self.last.control_us_max, "us")
                .within(0.0, CONTROL_US),
            Figure::told("mean that a frame took control", share * FRAME_US, "us"),
            Figure::told("the same", share * FRAME_CYCLES, "cycles"),
        ]
    }
}

/// The ticks: none may miss its frame.
pub(super) fn timing(wire: &mut Wire<'_>, asked: &Asked, _: Say<'_>) -> anyhow::Result<Vec<Figure>> {
    let mut counted = Counted::default();
    wire.hear(asked.lasts.unwrap_or(Duration::from_secs(60)), ALL, &mut |_, message| {
        counted.take(message);
        Ok(false)
    })?;
    Ok(counted.figures())
}

/// The line, with everything on it: nothing may be lost either way.
pub(super) fn line(wire: &mut Wire<'_>, asked: &Asked, _: Say<'_>) -> anyhow::Result<Vec<Figure>> {
    let lasts = asked.lasts.unwrap_or(Duration::from_secs(3_600));
    let (mut counted, mut trips, mut unanswered) = (Counted::default(), Vec::new(), 0_u32);
    let before = wire.client.counts();
    for _ in 0..lasts.as_secs().max(1) {
        wire.hear(PATIENCE, ALL, &mut |_, message| {
            counted.take(message);
            Ok(false)
        })?;
        let asked = Instant::now();
        match wire.client.ask(&Down::Ping, PATIENCE) {
            Ok(Answer::Done) => trips.push(asked.elapsed().as_secs_f64() * 1e3),
            _ => unanswered += 1,
        }
    }
    let after = wire.client.counts();
    let [half, most] = [0.5, 1.0].map(|part| not_exceeded(trips.clone(), part).unwrap_or(f64::NAN));
    let mut figures = vec![
        Figure::told("messages", (after.messages - before.messages) as f64, ""),
        Figure::none("messages missed", (after.missed - before.missed) as f64),
        Figure::none("bad frames up the line", (after.bad_frames - before.bad_frames) as f64),
        Figure::none("bad frames down the line", counted.more(|all| all.bad_frames)),
        Figure::none("messages that the board dropped", counted.more(|all| all.telemetry_dropped)),
        Figure::none("commands without an answer", unanswered),
        Figure::told("a command and its answer, half of them", half, "ms"),
        Figure::told("the longest", most, "ms"),
    ];
    figures.extend(counted.figures());
    Ok(figures)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line that delays by 1 to 17 ms, and a board whose clock is off by so many millionths.
    fn measured(off_ppm: f64) -> f64 {
        let heard: Vec<_> = (0..4_800_u32)
            .map(|n| {
                let is_s = f64::from(n) / 80.0;
                let delay_s = 0.001 * (1.0 + f64::from(n * 7 % 17));
                (is_s / (1.0 + off_ppm / 1e6) + delay_s, is_s)
            })
            .collect();
        drift(&heard).unwrap().0
    }

    #[test]
    fn a_clock_is_measured_through_a_line_that_delays() {
        for off_ppm in [0.0, 30.0, -190.0, 3_000.0, -10_000.0] {
            let ppm = measured(off_ppm);
            assert!((ppm - off_ppm).abs() < 3.0 + 0.01 * off_ppm.abs(), "{off_ppm}: {ppm}");
        }
    }
}
