//! The real image on the emulated board, against what it promises. Builds the image first if it is not built.
#![cfg(feature = "emulator")]

mod agreement;
mod coupling;
mod faults;
#[path = "../common/hash.rs"]
mod hash;
mod last;
mod link;
mod resets;
mod store;
mod streams;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Down, Event, EventKind};
use tenax_hal_shim::words::MotorStop;
use tenax_scene::World;
use tenax_scene::plant::{Pins, Plant};
use tenax_sim::board::Run;
use tenax_sim::board::agreement::Agreement;
use tenax_sim::board::emulated::Options;
use tenax_sim::session::{self, Board};

fn image() -> &'static Path {
    static IMAGE: OnceLock<PathBuf> = OnceLock::new();
    IMAGE.get_or_init(|| tenax_sim::image::build(root()).expect("the image"))
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package is in the workspace")
}

/// Every pin swings through the converter's range at its own phase; and somebody sends commands.
struct Swing {
    pins: Pins,
    swings: bool,
    scans: u32,
    duration_s: f64,
    commands: Vec<(f64, Down)>,
    /// Sent down as they are, 0.2 s after the start.
    bytes: Vec<u8>,
    trusts_line: bool,
    pressed_s: Option<std::ops::Range<f64>>,
}

impl Swing {
    fn new(duration_s: f64) -> Self {
        Self {
            pins: Pins::default(),
            swings: true,
            scans: 0,
            duration_s,
            commands: Vec::new(),
            bytes: Vec::new(),
            trusts_line: true,
            pressed_s: None,
        }
    }

    /// Every pin at rest.
    fn at_rest(self) -> Self {
        Self { swings: false, ..self }
    }

    fn sending(mut self, at_s: f64, command: Down) -> Self {
        self.commands.push((at_s, command));
        self
    }

    fn holding(mut self, at_s: f64, for_s: f64) -> Self {
        self.pressed_s = Some(at_s..at_s + for_s);
        self
    }

    fn t_s(&self) -> f64 {
        f64::from(self.scans) / f64::from(SCAN_HZ)
    }
}

impl Plant for Swing {
    fn scan(&mut self, _drive: MotorDrive) -> &Pins {
        self.scans += 1;
        for (index, volts) in self.pins.0.iter_mut().enumerate().filter(|_| self.swings) {
            *volts = 1.65 + 1.8 * (0.013 * f64::from(self.scans) + index as f64).sin();
        }
        &self.pins
    }

    fn commands(&mut self) -> Vec<Down> {
        let now_s = self.t_s();
        self.commands.extract_if(.., |(at_s, _)| *at_s <= now_s).map(|(_, command)| command).collect()
    }

    fn line_bytes(&mut self) -> Vec<u8> {
        if self.t_s() < 0.2 { Vec::new() } else { std::mem::take(&mut self.bytes) }
    }

    fn trusts_line(&self) -> bool {
        self.trusts_line
    }

    fn button(&self) -> bool {
        self.pressed_s.as_ref().is_some_and(|pressed_s| pressed_s.contains(&self.t_s()))
    }

    fn duration_s(&self) -> f64 {
        self.duration_s
    }
}

/// A shipped scene, or one of `tests/scenes/`, with seed 1.
fn scene(name: &str) -> World {
    let own = format!("{}/tests/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let asked = if Path::new(&own).exists() { &own } else { name };
    World::new(&session::load_scene(asked).expect("a scene"), 1)
}

fn run(plant: impl Plant + 'static, options: &Options) -> Run {
    let board = Board::Emulated { image: image().to_owned(), options: options.clone() };
    board.run(plant, &mut |_| {}).expect("the run").0
}

fn plain() -> &'static Run {
    static PLAIN: OnceLock<Run> = OnceLock::new();
    PLAIN.get_or_init(|| run(Swing::new(10.0), &Options::default()))
}

fn drives(run: &Run, from_s: f64, to_s: f64) -> &[MotorDrive] {
    let scan = |t_s: f64| (t_s * f64::from(SCAN_HZ)) as usize;
    &run.drives[scan(from_s)..scan(to_s).min(run.drives.len())]
}

/// Checks that the host's logic says the same of a run's codes and commands, bit for bit.
fn agrees(name: &str, run: &Run) {
    let agreement = Agreement::of(run);
    assert!(agreement.holds(), "{name}: {agreement}");
}

/// The motor's stops, None where it was freed.
fn stops(events: &[Event]) -> Vec<Option<MotorStop>> {
    let stop = |event: &Event| if let EventKind::Motor(stop) = event.kind { Some(stop) } else { None };
    events.iter().filter_map(stop).collect()
}
