//! The emulated board: the real image, instruction by instruction, with a plant at its pins.

pub(crate) mod cost;
pub mod coupling;
mod flash;
mod line;
mod mishaps;
mod nucleo;
pub(crate) mod wires;
mod world;

use std::num::NonZeroU64;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::time::Instant;

use anyhow::{Context, Result, anyhow, ensure};
use rigless::emulator::{self, Finished, Start, Watch};
use rigless::image::Image;
use rigless::session::Session;
use rigless::time::VirtualNanos;
use tenax_frames::link::Inbox;
use tenax_hal_shim::channel::{SCAN_HZ, SCANS_PER_FRAME};
use tenax_scene::plant::Plant;

use self::coupling::Coupling;
use self::nucleo::Nucleo;
use self::world::{Stretch, World};
use super::kept::{Provision, Sectors};
use super::simulated::frames_in;
use super::{FlashUse, Recorder, Summary};
use crate::image::symbols::Symbols;

#[derive(Clone, Debug)]
pub struct Options {
    /// Instructions a second: 100 and 50 millions are the ends of the bracket, at one to two cycles each and 100 MHz.
    pub instructions_per_second: NonZeroU64,
    /// What goes wrong on the way, and when, s.
    pub mishaps: Vec<(f64, Mishap)>,
    /// Contents of the flash beside the image: an address, and the bytes from there on. None: as the plant was set up.
    pub flash: Option<(u64, Vec<u8>)>,
    /// Time to program a word, us, in which the core stands still: 16 typically, 100 at most (DS10314).
    pub word_us: u64,
    /// BOR_LEV among the option bytes: 0 is level 3, 3 as the chip is delivered.
    pub brown_out_level: u8,
    /// Supply when the board is switched on, mV.
    pub supply_mv: u32,
    /// What the bridge's edges leave in the films' codes. None: nothing.
    pub coupling: Option<Coupling>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            instructions_per_second: NonZeroU64::new(100_000_000).expect("not zero"),
            mishaps: Vec::new(),
            flash: None,
            word_us: 16,
            brown_out_level: 0,
            supply_mv: 3_300,
            coupling: None,
        }
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Mishap {
    /// The converter's DMA stream switches off: the converter overruns.
    DmaStalls,
    Garbage(Vec<u8>),
    /// So many bytes of a million come down the line with a framing error.
    LineErrs(u32),
    CoreHangs,
    /// The converter's DMA stream does not stop when it is told to next.
    DmaSticks,
    /// The converter's DMA stream is sent where nothing is: its driver panics.
    DmaFails,
    /// The power goes for an instant while the flash programs the word after the next `words`.
    PowerFails(u32),
    BrownsOut,
    /// From now on the supply is so high, mV: the voltage detector says if it is too low. A brown-out's reset is not drawn by it.
    SupplyIs(u32),
    /// The clock security system reports it if it is on. True: the crystal is there again at the next start.
    CrystalStops(bool),
    /// With the crystal the PLL never locks.
    PllFails,
    ResetByPin,
    /// The core is sent where nothing is, and faults.
    CoreStrays,
    /// The bridge's nFAULT: true is low.
    BridgeIsOff(bool),
}

/// Boots `image` and runs the plant to its end; `recorder` is told of it as it goes, `progress` the virtual time now and then, s.
/// Fails if the image cannot be read or placed, or what it does would destroy a real board.
pub fn record<P: Plant + 'static>(
    image: &Path,
    plant: P,
    options: &Options,
    recorder: &mut dyn Recorder,
    progress: &mut dyn FnMut(f64),
) -> Result<(Summary, P)> {
    let provision = Provision::of(&plant)?;
    let frames = frames_in(plant.duration_s());
    let plant = Arc::new(Mutex::new(plant));
    let summary = closed_loop(image, plant.clone(), (provision, frames), options, recorder, progress)?;
    let plant = Arc::into_inner(plant).context("the emulator still has the plant")?;
    Ok((summary, plant.into_inner().unwrap_or_else(PoisonError::into_inner)))
}

fn closed_loop(
    image: &Path,
    plant: Arc<Mutex<dyn Plant>>,
    (mut provision, frames): (Provision, u32),
    options: &Options,
    recorder: &mut dyn Recorder,
    progress: &mut dyn FnMut(f64),
) -> Result<Summary> {
    let began = Instant::now();
    let symbols = Symbols::read(image)?;
    // What somebody else wants in the flash is not mixed with a calibration.
    if options.flash.is_some() {
        provision.calibrated = None;
    }
    let (sender, reports) = mpsc::channel();
    let world = World::new(plant, frames, options, &symbols, sender);
    let watched = [symbols.tick, symbols.after_tick, symbols.command];
    let mut images =
        vec![Image::read(image, None).context("reading the image")?, cost::paint(&symbols.stack)?];
    let kept = || Sectors::provisioned(&provision).image();
    let (address, bytes) = options.flash.clone().unwrap_or_else(kept);
    images.push(Image::new(Path::new("flash"), bytes, Some(address))?);
    let board = Nucleo::new(options)?;

    // The emulator keeps its driver for itself, so it runs on a thread of its own and reports to this one.
    let (mut heard, mut inbox, mut scanned) = (Summary::default(), Inbox::default(), 0);
    let finished = std::thread::scope(|scope| {
        let emulator = scope.spawn(move || execute(&images, board, watched, world));
        for Stretch { scans, line } in reports {
            scanned += scans.len();
            for (codes, drive) in scans {
                recorder.scan(&codes, drive);
            }
            heard.hear(&mut inbox, &line, frames, recorder);
            progress(scanned as f64 / f64::from(SCAN_HZ));
        }
        emulator.join().map_err(|_| anyhow!("the emulator panicked; its message is above"))?
    })?;

    let mut world = finished.driver;
    ensure!(
        !world.flash.options_written,
        "the image programs option bytes: a power cut then may lock the chip"
    );
    if let Some(broken) = world.broken {
        return Err(broken);
    }
    // What the last scans led to had time to come up the line; what came after them was no part of the run.
    let mut taken = world.taken(&heard.answers);
    taken.retain(|(before, _)| *before < frames);
    // What a frame decides is on the pin in the scans of the next.
    let frame_of = |scan: usize| (scan / SCANS_PER_FRAME).saturating_sub(1) as u32;
    let feedback = world.feedback.iter().map(|&(scan, duty)| (frame_of(scan), duty)).collect();
    Ok(Summary {
        virtual_s: scanned as f64 / f64::from(SCAN_HZ),
        wall_s: began.elapsed().as_secs_f64(),
        trusts_line: provision.trusts_line,
        taken,
        feedback,
        tick_cost: world.tick_cost,
        stack_bytes: world.stack_bytes,
        flash: FlashUse { words: world.flash.words, erases: world.flash.erases },
        calibrated: provision.calibrated,
        ..heard
    })
}

fn execute(
    images: &[Image],
    board: Nucleo,
    watched: [u64; 3],
    world: World,
) -> Result<Finished<Nucleo, World>> {
    let mut session = Session::new(Box::new(board), 0, VirtualNanos(1))?;
    for address in watched {
        session.watch(Watch::Instruction(address));
    }
    let mut finished = emulator::run(session, &Start::new(images), world).context("the emulator")?;
    finished.driver.reports = None;
    Ok(finished)
}
