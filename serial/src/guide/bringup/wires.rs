//! Wires of the switches that are taken off: how soon each is noticed, and what its neighbours say.

use std::time::{Duration, Instant};

use tenax_hal_shim::channel::{CHANNELS, COUNT, SLOW_HZ, STRAIN, mv_from_sample};
use tenax_hal_shim::wire::{Senses, Up};

use super::wire::{Stream, Wire};
use super::{Asked, Figure};
use crate::guide::Say;

/// Readings at the beginning that are taken for rest.
const REST: u32 = 2 * SLOW_HZ;
/// A wire has begun to fall when it is this far below its rest, mV.
const FALLS_MV: f64 = 20.0;
/// It is back within this of its rest, mV.
const BACK_MV: f64 = 40.0;
/// How soon it has to be below its least voltage, s.
const WITHIN_S: f64 = 0.5;
/// What a neighbour may move meanwhile, mV.
const CROSSTALK_MV: f64 = 5.0;
/// Readings of a cut wire that are averaged before its neighbours are looked at: noise is less than crosstalk then.
const AVERAGED: u32 = SLOW_HZ / 4;
/// How long a person may take for the next one.
const PATIENCE: Duration = Duration::from_secs(60);

/// What is known of the wires so far.
struct Wires {
    rest: [f64; COUNT],
    readings: u32,
    /// When the one that is taken off began to fall.
    falls: Option<(usize, f64)>,
    /// It has fallen: sums of all since, and how many.
    off: Option<([f64; COUNT], u32)>,
    /// Of each: how long it took, s.
    took: [Option<f64>; COUNT],
    crosstalk: (f64, [usize; 2]),
}

impl Wires {
    const fn new() -> Self {
        Self {
            rest: [0.0; COUNT],
            readings: 0,
            falls: None,
            off: None,
            took: [None; COUNT],
            crosstalk: (0.0, [STRAIN; 2]),
        }
    }

    /// Takes a reading; the wire that was noticed in it.
    fn take(&mut self, senses: &Senses) -> Option<usize> {
        let mv = senses.samples.map(|sample| f64::from(mv_from_sample(sample)));
        let at_s = f64::from(senses.frame) / 2_000.0;
        if self.readings < REST {
            self.readings += 1;
            let part = f64::from(self.readings);
            self.rest.iter_mut().zip(mv).for_each(|(rest, mv)| *rest += (mv - *rest) / part);
            return None;
        }
        let Some((wire, began_s)) = self.falls else {
            let falling = (STRAIN..COUNT).find(|&n| mv[n] < self.rest[n] - FALLS_MV);
            self.falls = falling.map(|wire| (wire, at_s));
            return None;
        };
        if (mv[wire] - self.rest[wire]).abs() < BACK_MV {
            (self.falls, self.off) = (None, None);
            return None;
        }
        let Some((sums, count)) = &mut self.off else {
            if mv[wire] >= f64::from(CHANNELS[wire].low_mv) {
                return None;
            }
            self.off = Some(([0.0; COUNT], 0));
            let took = self.took[wire].get_or_insert(0.0);
            *took = took.max(at_s - began_s);
            return Some(wire);
        };
        if *count < AVERAGED {
            *count += 1;
            sums.iter_mut().zip(mv).for_each(|(sum, mv)| *sum += mv);
            if *count == AVERAGED {
                for other in (STRAIN..COUNT).filter(|&n| n != wire) {
                    let moved = (sums[other] / f64::from(AVERAGED) - self.rest[other]).abs();
                    if moved > self.crosstalk.0 {
                        self.crosstalk = (moved, [wire, other]);
                    }
                }
            }
        }
        None
    }
}

/// Takes the wires' story down until each was off, or nobody takes one off any more.
pub(super) fn wires(wire: &mut Wire<'_>, asked: &Asked, say: Say<'_>) -> anyhow::Result<Vec<Figure>> {
    let all: Vec<usize> = asked.channels.iter().copied().filter(|&n| n >= STRAIN).collect();
    let (mut wires, mut last) = (Wires::new(), Instant::now());
    say("Touch nothing for 2 s.")?;
    let mut is_told = false;
    let patience = asked.lasts.unwrap_or(PATIENCE);
    loop {
        let stream = Stream { raw: false, senses: true };
        let is_over = wire.hear(Duration::from_secs(1), stream, &mut |_, message| {
            let Up::Senses(senses) = message else { return Ok(false) };
            if let Some(noticed) = wires.take(senses) {
                let took_s = wires.took[noticed].unwrap_or(f64::NAN);
                say(&format!("   {} off, noticed after {took_s:.2} s", CHANNELS[noticed].name))?;
                last = Instant::now();
            }
            if wires.readings == REST && !std::mem::replace(&mut is_told, true) {
                say("Now take one off after the other.")?;
            }
            let is_averaged = wires.off.is_none_or(|(_, count)| count == AVERAGED);
            Ok(is_averaged && all.iter().all(|&n| wires.took[n].is_some()))
        })?;
        if is_over || last.elapsed() > patience {
            break;
        }
    }
    for &missing in all.iter().filter(|&&n| wires.took[n].is_none()) {
        say(&format!("   {}: never below {} mV", CHANNELS[missing].name, CHANNELS[missing].low_mv))?;
    }
    let noticed = all.iter().filter_map(|&n| wires.took[n]);
    let slowest = noticed.clone().fold(0.0, f64::max);
    let count = all.len() as f64;
    let (moved, [off, other]) = wires.crosstalk;
    Ok(vec![
        Figure::told("wires whose cut was noticed", noticed.count() as f64, "").within(count, count),
        Figure::told("the slowest", slowest, "s").within(0.0, WITHIN_S),
        Figure::told(
            format!("{} moves when {} is off", CHANNELS[other].name, CHANNELS[off].name),
            moved,
            "mV",
        )
        .within(0.0, CROSSTALK_MV),
    ])
}
