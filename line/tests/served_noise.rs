//! Whatever comes down a line: nothing panics, and only a valid drive command moves the hand.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_sim::session::Board;
use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{BAUD, DRIVE_HOLD_MAX_MS, Down, Receiver, Setting};
use tenax_hal_shim::words::Code;
use tenax_logic::setting::SettingId;
use tenax_scene::plant::{Pins, Plant};
use tenax_frames::link::Encoder;

/// A hand at rest, and somebody who fills the line with anything.
struct Noise {
    pins: Pins,
    random: ChaCha8Rng,
    encoder: Encoder,
    drives: bool,
    waiting: Vec<u8>,
    /// What the bytes that were sent say, to a receiver of our own.
    receiver: Receiver,
    scans: u32,
    valid: u32,
    /// Scans in which a valid drive command was sent.
    driven: Vec<u32>,
    bytes: usize,
    duration_s: f64,
}

impl Noise {
    fn new(seed: u64, drives: bool, duration_s: f64) -> Self {
        Self {
            pins: Pins::default(),
            random: ChaCha8Rng::seed_from_u64(seed),
            encoder: Encoder::default(),
            drives,
            waiting: Vec::new(),
            receiver: Receiver::new(),
            scans: 0,
            valid: 0,
            driven: Vec::new(),
            bytes: 0,
            duration_s,
        }
    }

    fn command(&mut self) -> Down {
        let random = &mut self.random;
        let drive = Down::Drive {
            drive: MotorDrive::Close(Duty::per_mille(random.random_range(1..=1_000))),
            hold_ms: random.random_range(0..300),
        };
        let setting = SettingId::ALL[random.random_range(0..SettingId::ALL.len())].row();
        match random.random_range(0..10) {
            0 if self.drives => drive,
            1 => Down::Set(Setting { id: random.random(), value: random.random() }),
            2 => Down::Set(Setting {
                id: SettingId::by_name(setting.name).expect("its own name").number(),
                value: random.random_range(setting.min..=setting.max),
            }),
            3 => Down::Zero,
            4 => Down::Teach { codes: [Code::Minus, Code::Plus], age_ms: random.random_range(0..100) },
            5 => Down::Get(random.random()),
            6 => Down::Settings(random.random()),
            7 => Down::Samples,
            8 => Down::Network,
            _ => Down::Ping,
        }
    }

    /// Bytes of any kind: noise, a frame, or a frame with a fault in it.
    fn refill(&mut self) {
        let command = self.command();
        // Frames with faults are of drive commands too, whether valid ones are sent or not.
        let faulty = Down::Drive { drive: MotorDrive::Open(Duty::per_mille(1_000)), hold_ms: 200 };
        match self.random.random_range(0..4) {
            0 => {
                let length = self.random.random_range(1..800);
                self.waiting.extend((0..length).map(|_| self.random.random::<u8>()));
                // So that not everything after it is lost.
                self.waiting.push(0);
            }
            1 => {
                let mut frame = self.encoder.frame(&faulty).1.to_vec();
                let at = self.random.random_range(0..frame.len() - 1);
                match self.random.random_range(0..3) {
                    0 => frame[at] ^= 1 << self.random.random_range(0..8),
                    1 => frame.truncate(at),
                    _ => frame.insert(at, self.random.random_range(1..=255)),
                }
                self.waiting.extend(frame);
                self.waiting.push(0);
            }
            _ => self.waiting.extend(self.encoder.frame(&command).1),
        }
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
        self.bytes += length;
        for &byte in &bytes {
            let Some(Ok(command)) = self.receiver.push::<Down>(byte) else { continue };
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
        self.duration_s
    }
}

#[test]
fn noise_and_torn_frames_never_move_the_hand() {
    for seed in 0..4 {
        let (run, noise) = Board::Host.run(Noise::new(seed, false, 10.0), &mut |_| {}).unwrap();
        assert!(noise.bytes > 800_000 && noise.valid > 1_000, "{} bytes, {} valid", noise.bytes, noise.valid);
        assert!(noise.driven.is_empty(), "a CRC-32 lets one in four billion through");
        assert!(run.drives.iter().all(|drive| *drive == MotorDrive::Coast), "seed {seed}");
        assert!(run.counters.bad_frames > 1_000, "{:?}", run.counters);
    }
}

#[test]
fn a_valid_drive_command_moves_it_for_as_long_as_it_may() {
    let (run, noise) = Board::Host.run(Noise::new(9, true, 10.0), &mut |_| {}).unwrap();
    assert!(!noise.driven.is_empty());
    assert!(run.drives.iter().any(|drive| *drive != MotorDrive::Coast), "the absence above means something");
    // A backlog of commands is taken in a few ticks; the ring holds 11 ms of a full line.
    let hold = (u32::from(DRIVE_HOLD_MAX_MS) + 20) * SCAN_HZ / 1_000;
    for (scan, drive) in (0..).zip(&run.drives) {
        let told = noise.driven.iter().any(|&sent| (sent..sent + hold).contains(&scan));
        assert!(told || *drive == MotorDrive::Coast, "scan {scan}: {drive:?}");
    }
}
