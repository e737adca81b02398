//! Noise down the line: nothing panics, and only a valid drive command moves the hand.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_frames::link::Encoder;
use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{BAUD, DRIVE_HOLD_MAX_MS, Down, Receiver, Setting};
use tenax_logic::setting::SettingId;
use tenax_scene::plant::{Pins, Plant};
use tenax_sim::session::Board;

/// A hand at rest whose trusted line is full of noise, commands and torn drive commands for 10 s.
struct Noise {
    pins: Pins,
    random: ChaCha8Rng,
    encoder: Encoder,
    /// Valid drive commands are among the commands.
    drives: bool,
    waiting: Vec<u8>,
    receiver: Receiver,
    scans: u32,
    valid: u32,
    /// Scans in which a valid drive command was sent.
    driven: Vec<u32>,
}

impl Noise {
    fn run(seed: u64, drives: bool) -> (tenax_sim::board::Run, Self) {
        let noise = Self {
            pins: Pins::default(),
            random: ChaCha8Rng::seed_from_u64(seed),
            encoder: Encoder::default(),
            drives,
            waiting: Vec::new(),
            receiver: Receiver::new(),
            scans: 0,
            valid: 0,
            driven: Vec::new(),
        };
        Board::Host.run(noise, &mut |_| {}).unwrap()
    }

    fn command(&mut self) -> Down {
        let random = &mut self.random;
        let drive = MotorDrive::Close(Duty::per_mille(random.random_range(1..=1_000)));
        let id = SettingId::ALL[random.random_range(0..SettingId::ALL.len())];
        match random.random_range(0..8) {
            0 if self.drives => Down::Drive { drive, hold_ms: random.random_range(0..300) },
            1 => Down::Set(Setting { id: random.random(), value: random.random() }),
            2 => Down::Set(Setting {
                id: id.number(),
                value: random.random_range(id.row().min..=id.row().max),
            }),
            3 => Down::Zero,
            4 => Down::Get(random.random()),
            5 => Down::Settings(random.random()),
            6 => Down::Network,
            _ => Down::Ping,
        }
    }

    /// More bytes: noise, a torn drive command, or a command.
    fn refill(&mut self) {
        let (command, random) = (self.command(), &mut self.random);
        let bytes = match random.random_range(0..4) {
            0 => (0..random.random_range(1..800)).map(|_| random.random::<u8>()).chain([0]).collect(),
            1 => {
                let drive = MotorDrive::Open(Duty::per_mille(1_000));
                let mut frame = self.encoder.frame(&Down::Drive { drive, hold_ms: 200 }).1.to_vec();
                let at = random.random_range(0..frame.len() - 1);
                match random.random_range(0..3) {
                    0 => frame[at] ^= 1 << random.random_range(0..8),
                    1 => frame.truncate(at),
                    _ => frame.insert(at, random.random_range(1..=255)),
                }
                [&frame[..], &[0]].concat()
            }
            _ => self.encoder.frame(&command).1.to_vec(),
        };
        self.waiting.extend(bytes);
    }
}

impl Plant for Noise {
    fn scan(&mut self, _drive: MotorDrive) -> &Pins {
        self.scans += 1;
        &self.pins
    }

    /// As much as the real line carries.
    fn line_bytes(&mut self) -> Vec<u8> {
        let length = (BAUD / 10 / SCAN_HZ) as usize;
        while self.waiting.len() < length {
            self.refill();
        }
        let bytes: Vec<u8> = self.waiting.drain(..length).collect();
        for command in bytes.iter().filter_map(|&byte| self.receiver.push::<Down>(byte)).flatten() {
            self.valid += 1;
            if matches!(command.message, Down::Drive { .. }) {
                self.driven.push(self.scans);
            }
        }
        bytes
    }

    fn trusts_line(&self) -> bool {
        true
    }

    fn duration_s(&self) -> f64 {
        10.0
    }
}

#[test]
fn noise_and_torn_frames_never_move_the_hand() {
    for seed in 0..4 {
        let (run, noise) = Noise::run(seed, false);
        assert!(noise.driven.is_empty(), "a CRC-32 lets one in four billion through");
        assert!(run.drives.iter().all(|drive| *drive == MotorDrive::Coast), "seed {seed}");
        assert!(noise.valid > 1_000 && run.counters.bad_frames > 1_000, "{:?}", run.counters);
    }
}

#[test]
fn a_valid_drive_command_moves_it_for_as_long_as_it_may() {
    let (run, noise) = Noise::run(9, true);
    assert!(run.drives.iter().any(|drive| *drive != MotorDrive::Coast), "the absence above means something");
    // A backlog of commands is taken in a few ticks; the ring holds 11 ms of a full line.
    let hold = (u32::from(DRIVE_HOLD_MAX_MS) + 20) * SCAN_HZ / 1_000;
    for (scan, drive) in (0..).zip(&run.drives) {
        let told = noise.driven.iter().any(|&sent| (sent..sent + hold).contains(&scan));
        assert!(told || *drive == MotorDrive::Coast, "scan {scan}: {drive:?}");
    }
}
