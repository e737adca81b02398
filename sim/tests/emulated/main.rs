//! The real image on the emulated board, against what it promises. Builds the image first if it is not built.
#![cfg(feature = "emulator")]

mod agreement;
mod behaviours;
mod converter;
mod coupling;
mod faults;
mod feedback;
#[path = "../common/hash.rs"]
mod hash;
mod head;
mod last;
mod link;
mod motor;
#[path = "../common/onsets.rs"]
mod onsets;
mod resets;
mod store;
mod streams;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use tenax_hal_shim::channel::{FSR, FSR_COUNT, SCAN_HZ};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::Down;
use tenax_scene::plant::{Pins, Plant};
use tenax_sim::board::Run;
use tenax_sim::board::emulated::{self, Options};

/// The image of this checkout.
fn image() -> &'static Path {
    static IMAGE: OnceLock<PathBuf> = OnceLock::new();
    IMAGE.get_or_init(|| tenax_sim::image::build(root()).expect("the image"))
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package is in the workspace")
}

/// Every pin swings through the converter's range at its own phase, so that no two ever read alike for long; and somebody
/// sends commands.
struct Swing {
    pins: Pins,
    scans: u32,
    duration_s: f64,
    commands: Vec<(f64, Down)>,
    /// What is sent is carried out, whoever sends it. The tests of arming say otherwise.
    trusts_line: bool,
    pressed_s: Option<std::ops::Range<f64>>,
}

impl Swing {
    fn new(duration_s: f64) -> Self {
        Self {
            pins: Pins::default(),
            scans: 0,
            duration_s,
            commands: Vec::new(),
            trusts_line: true,
            pressed_s: None,
        }
    }

    fn sending(mut self, at_s: f64, command: Down) -> Self {
        self.commands.push((at_s, command));
        self
    }

    /// On a line that needs consent.
    fn stranger(mut self) -> Self {
        self.trusts_line = false;
        self
    }

    /// Somebody at the hand presses the button.
    fn pressing(self, at_s: f64) -> Self {
        self.holding(at_s, 0.1)
    }

    /// For so long.
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
        for (index, volts) in self.pins.0.iter_mut().enumerate() {
            *volts = 1.65 + 1.8 * (0.013 * f64::from(self.scans) + index as f64).sin();
        }
        &self.pins
    }

    fn commands(&mut self) -> Vec<Down> {
        let now_s = self.t_s();
        self.commands.extract_if(.., |(at_s, _)| *at_s <= now_s).map(|(_, command)| command).collect()
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

/// Every pin at rest, and somebody sends commands.
struct Rest(Swing, Pins);

impl Rest {
    fn new(swing: Swing) -> Self {
        Self(swing, Pins::default())
    }
}

impl Plant for Rest {
    fn within(&self) -> Option<&dyn Plant> {
        Some(&self.0)
    }

    fn within_mut(&mut self) -> Option<&mut dyn Plant> {
        Some(&mut self.0)
    }

    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        self.0.scan(drive);
        &self.1
    }
}

/// A finger that holds something from the start: that it was switched on is no consent.
struct Loaded(Rest);

impl Plant for Loaded {
    fn within(&self) -> Option<&dyn Plant> {
        Some(&self.0)
    }

    fn within_mut(&mut self) -> Option<&mut dyn Plant> {
        Some(&mut self.0)
    }

    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        self.0.1.0[FSR..FSR + FSR_COUNT].fill(1.2);
        self.0.scan(drive)
    }
}

fn run(plant: impl Plant + 'static, options: &Options) -> Run {
    emulated::run(image(), plant, options, &mut |_| {}).expect("the run").0
}

/// Ten seconds in which nothing happens but codes. Several tests look at them: a boot is dear.
fn plain() -> &'static Run {
    static PLAIN: OnceLock<Run> = OnceLock::new();
    PLAIN.get_or_init(|| run(Swing::new(10.0), &Options::default()))
}

/// The motor's drives between two instants.
fn drives(run: &Run, from_s: f64, to_s: f64) -> &[MotorDrive] {
    let scan = |t_s: f64| (t_s * f64::from(SCAN_HZ)) as usize;
    &run.drives[scan(from_s)..scan(to_s).min(run.drives.len())]
}
