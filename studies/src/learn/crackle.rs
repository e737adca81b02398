//! A film with a loose contact: it crackles now and then, whether anything slips or not. When learning which film to believe is
//! worth something.

use std::f64::consts::TAU;

use tenax_hal_shim::channel::{FRAME_HZ, PVDF_COUNT, SAMPLE_MAX};

use super::bench::Bench;
use super::control::Control;
use super::finger::Finger;
use super::holding::{self, Holding};
use super::report::Score;
use super::trial::Setup;
use super::{LESSONS, Options, held_out, lesson, seed};

/// The film that crackles.
const FILM: usize = 3;
/// A crackle lasts so long, frames, and rings in the band of slip, samples: 60 mV at the pin, below what S1 masks a film for.
const FRAMES: u32 = FRAME_HZ / 20;
const SIZE: f64 = 300.0;
const RING_HZ: f64 = 60.0;
/// One in so many stretches of that length has one: two in a second.
const ONE_IN: u32 = 10;
/// Minutes of holding.
const MINUTES: u64 = 10;

/// Puts what crackles on the film's sample of this frame.
pub(super) fn crackle(pvdf: &mut [u16; PVDF_COUNT], frame: u32) {
    let stretch = (frame / FRAMES).wrapping_mul(0x9E37_79B9) >> 16;
    if stretch.is_multiple_of(ONE_IN) {
        let ring = SIZE * (TAU * RING_HZ * f64::from(frame % FRAMES) / f64::from(FRAME_HZ)).sin();
        pvdf[FILM] = (f64::from(pvdf[FILM]) + ring).clamp(0.0, f64::from(SAMPLE_MAX)) as u16;
    }
}

/// Held-out trials and holding of one of two.
pub type Tried = (Score, Holding);

/// A plain finger of which one film crackles learns; then it is tried with what it has learned, and with equal weights.
/// Fails if a scene cannot be made.
pub fn compare(options: &Options) -> anyhow::Result<[Tried; 2]> {
    let finger = options.finger(Finger::plain(options.seed));
    let mut learned = Bench::with_settings(&options.settings)?.crackling();
    for n in 0..LESSONS {
        learned.trial(Setup::new(&finger, lesson(options.seed, n), true)?);
    }
    let equal = learned.controlled(Some(Control::EqualWeights))?;
    let tried = |mut bench: Bench| -> anyhow::Result<Tried> {
        let holding = holding::hold(&finger, &bench, MINUTES, seed(options.seed, 8, 0), &|| ())?;
        let mut trials = Vec::new();
        for n in 0..options.trials {
            trials.push(bench.trial(Setup::new(&finger, held_out(options.seed, n), false)?));
        }
        Ok((Score::of(&trials), holding))
    };
    Ok([tried(learned)?, tried(equal)?])
}
