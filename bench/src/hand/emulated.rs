//! A hand whose fingertips and palm are the real images, instruction by instruction, on one bus.
//!
//! Each image runs on a thread of its own and stops every 12.5 us, where all wait for each other: the bytes that each put on the wires go
//! to the others, [`DELAY_SLOTS`] later. So the wires are as if they were long; nothing else differs from a bus without
//! stops. The images' crystals are one.

mod course;
mod hub;
mod palm;
mod replay;
mod world;

use std::fmt;
use std::num::NonZeroU64;
use std::path::Path;
use std::sync::Arc;
use std::thread::ScopedJoinHandle;

use anyhow::{Context, Result, anyhow};
use rigless::emulator::{self, Driver, Start, Watch};
use rigless::image::Image;
use rigless::session::Session;
use rigless::time::VirtualNanos;
use serde::Serialize;
use tenax_board_model::Models;
use tenax_board_model::line::Line;
use tenax_board_model::nucleo::Nucleo;
use tenax_palm::bus::Chip;
use tenax_palm::line;
use tenax_palm::palm::Report;
use tenax_palm::places::{Place, Places, pack};
use tenax_scene::SceneFile;
use tenax_scene::fingers::Fingers;

use self::hub::{Hand, Hub};
pub use self::palm::{Agreement as PalmAgreement, to_finger};
pub use self::replay::Agreement;
use self::world::{Log, World};
use crate::board::emulated::cost::paint;
use crate::board::kept::{Provision, STORE, Sectors, model_of};
use crate::image::symbols::{PalmSymbols, Symbols};

/// Slots of a byte from the sender to a finger: the longest time between two stops.
pub const DELAY_SLOTS: u64 = 8;
/// Where the chip keeps its number (RM0383, section 24.1).
const CHIP_AT: u64 = 0x1FFF_7A10;

#[derive(Clone, Debug)]
pub struct Options {
    pub seed: u64,
    /// When it ends, s; the scene's end if that comes first.
    pub until_s: f64,
    /// Of each core.
    pub instructions_per_second: NonZeroU64,
    /// Which models the chips are made of.
    pub models: Models,
    /// What a PC sends to the palm, and when, s.
    pub commands: Vec<(f64, line::Down)>,
    /// Who loses the interrupt that ends an answer, once, so that its driver stays on, and from when on, s.
    pub stuck: Option<(f64, usize)>,
}

impl Default for Options {
    fn default() -> Self {
        let instructions_per_second = NonZeroU64::new(100_000_000).expect("not zero");
        Self {
            seed: 101,
            until_s: f64::INFINITY,
            instructions_per_second,
            models: Models::Quick,
            commands: Vec::new(),
            stuck: None,
        }
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct Finger {
    /// Whether the host's build of the logic and of the end of the bus, given what this image was given, says the same.
    pub agreement: Agreement,
    /// Messages that came up its line through the palm, and those that did not, or were none.
    pub messages: u64,
    pub missing: u64,
    /// Answers to commands among them.
    pub answers: u64,
    /// Ticks that ended late, frames lost, messages dropped, as it counts.
    pub late: u32,
    pub lost: u32,
    pub dropped: u32,
    pub stack_bytes: u64,
    /// Everything that the core executed in a second.
    pub instructions_per_s: f64,
}

/// The palm's image.
#[derive(Clone, Debug, Serialize)]
pub struct PalmDid {
    /// Whether the host's build of the palm, given what this image was given, says the same.
    pub agreement: PalmAgreement,
    pub stack_bytes: u64,
    /// Everything that the core executed in a second.
    pub instructions_per_s: f64,
}

#[derive(Clone, Debug, Serialize)]
pub struct Outcome {
    pub name: String,
    pub fingers: Vec<Finger>,
    pub palm: PalmDid,
    pub seconds: f64,
    pub dropped: bool,
    /// The longest cycle of polls, us, and how many there were.
    pub cycle_us: u32,
    pub cycles: u32,
    /// From the last byte of a poll on the wires to the first of its answer, us: the longest, the wires' delay left out.
    pub answer_us: f64,
    /// Bytes that two drivers garbled.
    pub garbled: u64,
    /// How far the frames' ends that the palm was told were off, us; the wires' delay of 16 us is in it.
    pub clock_us: f64,
    /// What the palm reported and answered on its line, and when, s.
    #[serde(skip)]
    pub reports: Vec<(f64, Report)>,
    #[serde(skip)]
    pub said: Vec<(f64, line::Up)>,
}

impl Outcome {
    /// Whether the images did as the host's build does, and as they promise.
    pub fn holds(&self) -> bool {
        self.palm.agreement.holds()
            && self.fingers.iter().all(|finger| {
                finger.agreement.holds()
                    && finger.agreement.left_out == 0
                    && finger.missing == 0
                    && finger.late + finger.lost == 0
            })
    }
}

/// Runs the hand of a scene on images, the fingertips' and the palm's. Fails if one cannot be read or placed, or falls silent.
pub fn run([image, palm_image]: [&Path; 2], scene: &SceneFile, options: &Options) -> Result<Outcome> {
    let fingers = Fingers::new(scene, options.seed).context("the scene has no [fingers]")?;
    let count = fingers.fingers().len();
    let wearer = fingers.calibrated().map(|calibrated| model_of(&calibrated)).transpose()?;
    let provision = Provision { calibrated: wearer, ..Provision::default() };
    let chips: Vec<Chip> = (0..count as u32).map(|n| [options.seed as u32, 7, n]).collect();
    let ceiling_mn = provision.device().fingertip().config().grip.ceiling_mn;
    let normals =
        fingers.fingers().iter().map(|finger| finger.pushes().map(|part| (part * 1e3).round() as i16));
    let places: Places =
        chips.iter().zip(normals).map(|(&chip, normal)| Place { chip, normal, ceiling_mn }).collect();
    let symbols = Symbols::read(image)?;
    let seconds = scene.duration_s().min(options.until_s);
    let palm_symbols = PalmSymbols::read(palm_image)?;
    let hub = Arc::new(Hub::new(Hand::new(fingers)));
    let palm_world = palm::World::new(count, hub.clone(), palm_symbols.clone(), seconds, &options.commands);
    let cores = (options.models, options.instructions_per_second);
    let kept = Sectors::provisioned(&provision).image();

    let (runs, palm_ran) = std::thread::scope(|scope| {
        let palm = scope.spawn(|| {
            let kept = pack(&places).context("more fingers than a palm has")?;
            let images = [
                Image::read(palm_image, None).context("reading the palm's image")?,
                paint(&palm_symbols.stack)?,
                Image::new(
                    Path::new("flash"),
                    kept.iter().flat_map(|word| word.to_le_bytes()).collect(),
                    Some(STORE),
                )?,
            ];
            let ran = execute(&images, cores, &palm_symbols.does, palm_world);
            if ran.is_err() {
                hub.leave();
            }
            Ok(ran?.log)
        });
        let images: Vec<_> = chips
            .iter()
            .enumerate()
            .map(|(n, chip)| {
                let stuck_s = options.stuck.filter(|(_, who)| *who == n).map(|(at_s, _)| at_s);
                let (hub, symbols, kept) = (hub.clone(), &symbols, &kept);
                scope.spawn(move || {
                    let number = chip.iter().flat_map(|word| word.to_le_bytes()).collect();
                    let images = [
                        Image::read(image, None).context("reading the image")?,
                        paint(&symbols.stack)?,
                        Image::new(Path::new("flash"), kept.1.clone(), Some(kept.0))?,
                        Image::new(Path::new("chip"), number, Some(CHIP_AT))?,
                    ];
                    let world = World::new(n, hub.clone(), symbols.clone(), seconds, stuck_s);
                    let does = symbols.bus.into_iter().chain([symbols.tick, symbols.command]);
                    let ran = execute(&images, cores, &does.collect::<Vec<_>>(), world);
                    if ran.is_err() {
                        hub.leave();
                    }
                    Ok(ran?.log)
                })
            })
            .collect();
        (images.into_iter().map(join).collect::<Vec<Result<Log>>>(), join(palm))
    });
    let logs = runs.into_iter().collect::<Result<Vec<Log>>>()?;
    let palm = palm_ran?;
    let hand = Arc::into_inner(hub).context("an image still has the hub")?.into_hand()?;
    let done = logs.iter().enumerate().map(|(n, log)| {
        let counters = log.counters();
        let line = palm.lines[n].counts();
        Finger {
            agreement: Agreement::of(log, chips[n], wearer.as_ref()),
            messages: line.messages,
            missing: line.missed + line.bad_frames,
            answers: palm.answers[n],
            late: counters.ticks_late,
            lost: counters.frames_lost + counters.overruns,
            dropped: counters.telemetry_dropped,
            stack_bytes: log.kept.stack_bytes,
            instructions_per_s: log.kept.instructions_per_s,
        }
    });
    let fingers = done.collect();
    Ok(Outcome {
        name: scene.name.clone(),
        fingers,
        palm: PalmDid {
            agreement: PalmAgreement::of(&palm, &places),
            stack_bytes: palm.kept.stack_bytes,
            instructions_per_s: palm.kept.instructions_per_s,
        },
        seconds,
        dropped: hand.fingers.is_dropped(),
        cycle_us: hand.cycle_us,
        cycles: hand.cycles,
        answer_us: hand.answer_ns as f64 / 1e3,
        garbled: hand.garbled,
        clock_us: hand.clock_us,
        reports: palm.reports,
        said: palm.said,
    })
}

fn join<T>(thread: ScopedJoinHandle<'_, Result<T>>) -> Result<T> {
    thread.join().map_err(|_| anyhow!("the emulator panicked; its message is above")).flatten()
}

fn execute<W: Driver<Nucleo> + 'static>(
    images: &[Image],
    (models, rate): (Models, NonZeroU64),
    does: &[u64],
    world: W,
) -> Result<W> {
    let board = Nucleo::new(models, rate, Line::default())?;
    let mut session = Session::new(Box::new(board), 0, VirtualNanos(1))?;
    for &address in does {
        session.watch(Watch::Instruction(address));
    }
    let finished = emulator::run(session, &Start::new(images), world).context("the emulator")?;
    Ok(finished.driver)
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, palm, seconds, dropped, cycle_us, cycles, answer_us, garbled, clock_us, .. } = self;
        writeln!(f, "{name}, {seconds} s, each fingertip and the palm an image")?;
        writeln!(f, "  object      {}", if *dropped { "dropped" } else { "kept" })?;
        writeln!(
            f,
            "  bus         {cycles} cycles, {cycle_us} us at most; an answer begins within {answer_us:.0} us, clocks within {clock_us:.0} us; {garbled} bytes garbled"
        )?;
        for (report, t_s) in self.reports.iter().map(|(t_s, report)| (report, t_s)) {
            writeln!(f, "  {t_s:>7.3} s   {report:?}")?;
        }
        let PalmDid { agreement, stack_bytes, instructions_per_s } = palm;
        writeln!(
            f,
            "palm\n  host        {agreement}\n  image       {:.1} M instructions a second, stack {stack_bytes} bytes",
            instructions_per_s / 1e6
        )?;
        for (n, finger) in self.fingers.iter().enumerate() {
            let Finger { agreement, messages, missing, late, lost, stack_bytes, instructions_per_s, .. } =
                finger;
            writeln!(f, "finger {}\n  host        {agreement}", n + 1)?;
            writeln!(
                f,
                "  image       {late} ticks late, {lost} frames lost; {:.1} M instructions a second, stack {stack_bytes} bytes; {messages} messages through the palm, {missing} missing",
                instructions_per_s / 1e6
            )?;
        }
        Ok(())
    }
}
