//! The array detector's arithmetic on the emulated core: what it gives for any readings, and what it costs.
//!
//! The image is `firmware/src/bin/kernels`. Whenever its core arrives at `tenax_kernels_next`, the answer to the last
//! reading is taken out of its memory and the next reading put there ([`bench`]); the kernels' entries and returns are
//! watched, and the difference of the instruction counts there is what each cost ([`meter`]).

mod bench;
pub mod cycles;
mod meter;
pub mod pictures;
#[cfg(unix)]
pub mod qemu;

use std::collections::BTreeMap;
use std::num::NonZeroU64;
use std::path::Path;
use std::sync::mpsc;

use anyhow::{Context, Result, anyhow, bail};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rigless::emulator::{self, Finished, Start, Watch};
use rigless::image::Image;
use rigless::session::Session;
use rigless::time::VirtualNanos;
use tenax_hal_shim::frame::Frame;
use tenax_logic::array::{ArrayDetector, ArrayVerdict, Features, Reading};

use self::bench::Bench;
use self::cycles::Tracer;
use self::meter::Meters;
use crate::image::kernels::KernelSymbols;
use crate::image::timing::Flash;
use tenax_board_model::Models;
use tenax_board_model::line::Line;
use tenax_board_model::nucleo::Nucleo;

pub use self::meter::Cost;

const INSTRUCTIONS_PER_SECOND: NonZeroU64 = NonZeroU64::new(100_000_000).expect("not zero");

/// What the core made of one reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answer {
    pub verdict: ArrayVerdict,
    /// What by. None while its windows are not full or too many elements have no reading.
    pub evidence: Option<Evidence>,
}

/// What a verdict is given by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Evidence {
    pub features: Features,
    /// What the network made of them.
    pub logit: i32,
}

impl Answer {
    /// What a detector on this machine says to a reading, for comparison.
    pub fn of<const H1: usize, const L: usize, const H2: usize, const N: usize, const M: usize>(
        detector: &mut ArrayDetector<'_, H1, L, H2, N, M>,
        reading: &Reading,
    ) -> Self {
        let verdict = detector.push(reading);
        let evidence = detector.logit().map(|logit| Evidence { features: *detector.features(), logit });
        Self { verdict, evidence }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernels {
    Detector,
    /// The detector and its parts, each by itself.
    All,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// For each recording, for each reading.
    pub answers: Vec<Vec<Answer>>,
    /// Every kernel that ran, by name.
    pub costs: Vec<Cost>,
    /// Least, likely and most cycles of those that were followed.
    pub cycles: BTreeMap<String, [f64; 3]>,
    /// What RAM holds at the end, words.
    pub ram: Vec<u32>,
}

/// Puts recordings through the detector of the kernels' `image`
/// ([`build_kernels`](crate::image::build_kernels)); it forgets one before the next.
///
/// `progress` is told now and then how many readings have been answered.
/// Fails if the image cannot be read or placed, or its core does not come back for the next reading.
pub fn run(
    image: &Path,
    recordings: &[Vec<Reading>],
    kernels: Kernels,
    progress: &mut dyn FnMut(usize),
) -> Result<Outcome> {
    run_frames(image, recordings, &[], kernels, progress)
}

/// The same, and then `frames` through the other detectors' kernels, one after the other.
pub fn run_frames(
    image: &Path,
    recordings: &[Vec<Reading>],
    frames: &[Frame],
    kernels: Kernels,
    progress: &mut dyn FnMut(usize),
) -> Result<Outcome> {
    followed(image, recordings, frames, None, kernels, progress)
}

/// The same; from so many readings and frames on, kernels are followed one instruction at a time, in this flash.
fn followed(
    image: &Path,
    recordings: &[Vec<Reading>],
    frames: &[Frame],
    from: Option<(usize, Flash)>,
    kernels: Kernels,
    progress: &mut dyn FnMut(usize),
) -> Result<Outcome> {
    let symbols = KernelSymbols::read(image)?;
    let images = [Image::read(image, None).context("reading the image")?];
    let (sender, reports) = mpsc::channel();
    let bench = Bench::new(&symbols, recordings, frames, kernels, sender).following(match from {
        Some((from, flash)) => Some((from, Tracer::new(image, &symbols, flash)?)),
        None => None,
    });
    // The emulator keeps its driver for itself, so it runs on a thread of its own and reports to this one.
    let finished = std::thread::scope(|scope| {
        let emulator = scope.spawn(|| execute(&images, &symbols, bench));
        for answered in reports {
            progress(answered);
        }
        emulator.join().map_err(|_| anyhow!("the emulator panicked; its message is above"))?
    })?;
    let bench = finished.driver;
    if !bench.is_done() {
        bail!("the kernels' image stopped at reading {}: has it panicked?", bench.answered());
    }
    Ok(bench.into_outcome())
}

/// Every kernel's cost on the readings of a hand that holds something: noise, and now and then a slip. Fails as [`run`] does.
pub fn costs(image: &Path) -> Result<Vec<Cost>> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut reading = |n: usize| -> Reading {
        let spread = if (n / 40).is_multiple_of(2) { 5 } else { 200 };
        std::array::from_fn(|_| Some(2_000 + random.random_range(0..spread)))
    };
    let readings = (0..400).map(&mut reading).collect();
    Ok(run(image, &[readings], Kernels::All, &mut |_| {})?.costs)
}

fn execute(images: &[Image], symbols: &KernelSymbols, bench: Bench) -> Result<Finished<Nucleo, Bench>> {
    let board = Nucleo::new(Models::Quick, INSTRUCTIONS_PER_SECOND, Line::default())?;
    let mut session = Session::new(Box::new(board), 0, VirtualNanos(1))?;
    for address in Meters::watched(&symbols.kernels).chain([symbols.next]) {
        session.watch(Watch::Instruction(address));
    }
    let mut finished = emulator::run(session, &Start::new(images), bench).context("the emulator")?;
    finished.driver.stop_reporting();
    Ok(finished)
}
