//! Where the information is: how soon anybody could tell slip from the films, the gauges, the force sensor.
//!
//! A trial is run twice with the same chance, once as it is and once on a surface that holds whatever is asked of it. What differs
//! at the pins is all that slip does to them, and over the noise of the pins it is d', by which the best observer (a matched filter
//! that knows finger, object, instant, and every voltage in advance) tells the two apart. No detector is sooner.
//!
//! An observer that may be wrong once in 3 h, and decides anew every 10 ms, says it when d' is [`CERTAIN`].

use rayon::prelude::*;
use serde::Serialize;
use tenax_hal_shim::channel::{
    ARRAY, CODE_MAX, FRAME_HZ, FRAMES_PER_SLOW_FRAME, FSR, PVDF, REFERENCE_MV, SCANS_PER_FRAME, STRAIN,
};
use tenax_hal_shim::frame::{Frame, Scan, scan_of_pins};
use tenax_hal_shim::motor::MotorDrive;
use tenax_logic::fingertip::Fingertip;
use tenax_scene::World;
use tenax_scene::plant::Plant;

use super::finger::Finger;
use super::report::Spread;
use super::trial::{Setup, Trial};
use super::{held_out, seed};

/// One false alarm in 3 h of decisions every 10 ms is one in 1.08 million: 4.75 standard deviations, seen half of the time.
pub const CERTAIN: f64 = 4.75;
/// How long is watched from the lift on, s.
const WATCHED_S: f64 = 1.6;
/// Friction of a surface that holds.
const HOLDS: f64 = 3.0;
/// One code, and what rounding to it adds to noise, V.
const ROUNDING_V: f64 = REFERENCE_MV as f64 / 1e3 / (CODE_MAX as f64 + 1.0) / 3.464_101_615_137_754_6;
/// Frames between two rows of what rises.
const ROW_FRAMES: u32 = FRAME_HZ / 100;

/// The senses that are asked, in this order.
pub const SENSES: [&str; 4] = ["films", "gauges", "force sensor", "all of them"];

/// One trial, s from the beginning of the lift.
#[derive(Clone, Debug, Default)]
pub struct Watched {
    /// The first place lets go.
    pub micro_s: f64,
    /// All of it slides.
    pub macro_s: f64,
    /// A camera without delay sees it, if it does, and with its delay.
    pub seen_s: Option<[f64; 2]>,
    /// When each of [`SENSES`] is certain, if ever.
    pub certain_s: [Option<f64>; SENSES.len()],
    /// d' of each, a hundred times a second.
    pub rising: Vec<(f64, [f64; SENSES.len()])>,
}

/// Watches the held-out trials of a finger. Fails if a scene cannot be made.
pub fn watch(finger: &Finger, all: u64, trials: u64) -> anyhow::Result<Vec<Watched>> {
    (0..trials)
        .into_par_iter()
        .map(|n| {
            let slips = Setup::changed(finger, held_out(all, n), false, &[])?;
            let holds = [("contact.mu_s", HOLDS), ("contact.mu_d", HOLDS)];
            let holds = Setup::changed(finger, held_out(all, n), false, &holds)?;
            Ok(both(slips, holds.world))
        })
        .collect()
}

fn both(slips: Setup, mut holds: World) -> Watched {
    let Setup { mut world, lift_s } = slips;
    let mut watched = Watched::default();
    let mut noise = Noise::default();
    // d'^2 of films, gauges, force sensor.
    let mut squares = [0.0; 3];
    // It only carries the commands out.
    let mut fingertip = Fingertip::trusting();
    let mut drive = MotorDrive::Coast;
    for frame in 0..((lift_s + WATCHED_S) * f64::from(FRAME_HZ)) as u32 {
        let select = Frame::lost(frame).select();
        let mut scans = [Scan::default(); SCANS_PER_FRAME];
        let switched = frame.is_multiple_of(FRAMES_PER_SLOW_FRAME.into());
        for (n, scan) in scans.iter_mut().enumerate() {
            let felt = world.scan(drive).clone();
            let other = holds.scan(drive);
            *scan = scan_of_pins(&felt.codes(), select);
            for command in world.commands() {
                // A refusal goes back to whoever sent it; there is no line here.
                let _ = fingertip.command(&command);
            }
            let t_s = world.now_s() - lift_s;
            if t_s < 0.0 {
                noise.hear(n, t_s, &felt.0);
                continue;
            }
            let apart = |pin: usize| {
                let over = (felt.0[pin] - other.0[pin]) / noise.of(pin);
                over * over
            };
            squares[0] += (PVDF..STRAIN).map(apart).sum::<f64>();
            if switched && n == 0 {
                squares[1] += (STRAIN..FSR).map(apart).sum::<f64>();
                squares[2] += (FSR..ARRAY).map(apart).sum::<f64>();
            }
        }
        let t_s = world.now_s() - lift_s;
        if t_s >= 0.0 {
            let [films, gauges, force] = squares;
            let told = [films, gauges, force, films + gauges + force].map(f64::sqrt);
            for (certain_s, told) in watched.certain_s.iter_mut().zip(told) {
                if told >= CERTAIN && certain_s.is_none() {
                    *certain_s = Some(t_s);
                }
            }
            if frame.is_multiple_of(ROW_FRAMES) {
                watched.rising.push((t_s, told));
            }
        }
        drive = fingertip.tick(&Frame::from_scans(frame, &scans));
        while fingertip.next_event().is_some() {}
    }
    let mut trial = Trial { lift_s, ..Trial::default() };
    trial.end(world.truth().clone());
    let truth = &trial.truth;
    if let Some(up) = truth.slips.iter().find(|slip| !slip.meant && slip.macro_onset_s > lift_s) {
        (watched.micro_s, watched.macro_s) = (up.micro_onset_s - lift_s, up.macro_onset_s - lift_s);
    }
    let seen = trial.vision_without_delay_s().zip(trial.vision_s());
    watched.seen_s = seen.map(|(at_once_s, s)| [at_once_s - lift_s, s - lift_s]);
    watched
}

/// Noise of each pin, from the last 0.3 s before the lift: half the mean square of what differs between two readings.
#[derive(Default)]
struct Noise {
    last: [f64; ARRAY],
    squares: [f64; ARRAY],
    counts: [f64; ARRAY],
}

impl Noise {
    fn hear(&mut self, scan: usize, t_s: f64, felt: &[f64]) {
        for (pin, &now) in felt.iter().enumerate().take(ARRAY) {
            // What is switched changes once a frame.
            if pin >= STRAIN && scan > 0 {
                continue;
            }
            let apart = now - std::mem::replace(&mut self.last[pin], now);
            if t_s > -0.3 {
                self.squares[pin] += apart * apart / 2.0;
                self.counts[pin] += 1.0;
            }
        }
    }

    fn of(&self, pin: usize) -> f64 {
        (self.squares[pin] / self.counts[pin].max(1.0) + ROUNDING_V * ROUNDING_V).sqrt()
    }
}

/// A finger's leads over the camera, s: means.
#[derive(Clone, Debug, Serialize)]
pub struct Bound {
    /// Seed of the whole, and the finger's number: 0 is the plain one.
    pub finger: [u64; 2],
    /// What sliding keeps of static friction.
    pub ratio: f64,
    /// The first place lets go so long before the camera says it, and before one without delay.
    pub first_place_s: [f64; 2],
    /// All of it slides so long before.
    pub macro_s: [f64; 2],
    /// Each of [`SENSES`] could tell it so long before.
    pub certain_s: [[f64; 2]; SENSES.len()],
}

impl Bound {
    /// Of the trials that a camera saw.
    pub fn of(finger: [u64; 2], ratio: f64, trials: &[Watched]) -> Self {
        let lead = |when: &dyn Fn(&Watched) -> Option<f64>| {
            [1, 0].map(|delay| {
                let leads: Vec<f64> =
                    trials.iter().filter_map(|trial| Some(trial.seen_s?[delay] - when(trial)?)).collect();
                Spread::of(&leads).mean
            })
        };
        let mut certain_s = [[0.0; 2]; SENSES.len()];
        for (n, lead_s) in certain_s.iter_mut().enumerate() {
            *lead_s = lead(&|trial| trial.certain_s[n]);
        }
        Self {
            finger,
            ratio,
            first_place_s: lead(&|trial| Some(trial.micro_s)),
            macro_s: lead(&|trial| Some(trial.macro_s)),
            certain_s,
        }
    }
}

/// The plain finger and so many made by chance, with the same trials as `tenax learn` of this seed. Fails if a scene cannot be made.
pub fn bounds(all: u64, fingertips: u64, trials: u64) -> anyhow::Result<(Vec<Bound>, Vec<Watched>)> {
    let plain = Finger::plain(all);
    let watched = watch(&plain, all, trials)?;
    let mut bounds = vec![Bound::of([all, 0], plain.ratio(), &watched)];
    for n in 1..=fingertips {
        let own = seed(all, 6, n);
        let finger = Finger::random(own);
        bounds.push(Bound::of([all, n], finger.ratio(), &watch(&finger, own, trials)?));
    }
    Ok((bounds, watched))
}
