//! A fingertip on a bench, with a voltage for every pin: shared by all tests in `tests/`.
#![forbid(unsafe_code)]

pub mod teaching;

use std::f64::consts::TAU;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_hal_shim::channel::{
    ARRAY, ARRAY_COUNT, CHANNELS, COUNT, FRAMES_PER_SLOW_FRAME, FSR, FSR_COUNT, HIGH_SELECT, MYO_EXTENSOR,
    MYO_FLEXOR, PVDF, PVDF_COUNT, RANK_SWITCH_A, RANK_SWITCH_B, SAMPLE_MAX, sample_from_mv,
};
use tenax_hal_shim::frame::{Frame, scan_of_pins};
use tenax_hal_shim::front_end::{MYO_REST_MV, fsr_mv, fsr_quadrants_n};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::schedule::{Job, slot_of};
use tenax_hal_shim::wire::{Down, Event, EventKind, Setting, Slow, TickRecord};
use tenax_hal_shim::words::{Cause, DriveSource, Fault, GripMode, Kept, Reason};
use tenax_logic::emg::model::EmgModel;
use tenax_logic::fingertip::Fingertip;
use tenax_logic::samples::LastSamples;
use tenax_logic::setting::SettingId;
use tenax_logic::store::payload;

/// Opening of the scenes' hand at full duty, mm a frame: 120 mm/s.
const FULL_DUTY_MM: f64 = 120.0 / 2_000.0;

fn relaxed() -> [f64; COUNT] {
    let mut pins_mv = CHANNELS.map(|channel| f64::from(channel.rest_mv));
    pins_mv[MYO_FLEXOR] += 50.0;
    pins_mv[MYO_EXTENSOR] += 50.0;
    pins_mv
}

pub fn calibrated() -> Fingertip {
    let mut fingertip = Fingertip::trusting();
    fingertip.restore(Kept::Emg, &payload::of_emg(&wearer()));
    fingertip
}

pub fn wearer() -> EmgModel {
    EmgModel::of_uv([50_000; 2], [900_000, 95_000], [80_000, 560_000]).expect("they separate")
}

pub fn set(id: SettingId, value: i32) -> Down {
    Down::Set(Setting { id: id.number(), value })
}

pub fn gauss(rng: &mut ChaCha8Rng) -> f64 {
    (0..12).map(|_| rng.random_range(-0.5..0.5)).sum()
}

pub fn opens(drives: &[MotorDrive]) -> bool {
    drives.iter().any(|drive| drive.opens())
}

pub fn closes(drives: &[MotorDrive]) -> bool {
    closing_frames(drives) > 0
}

pub fn closing_frames(drives: &[MotorDrive]) -> usize {
    drives.iter().filter(|drive| drive.closes()).count()
}

pub fn rests(drives: &[MotorDrive]) -> bool {
    drives.iter().all(|drive| *drive == MotorDrive::Coast)
}

fn moved_mm(drive: MotorDrive) -> (f64, f64) {
    let mm = |duty: Duty| FULL_DUTY_MM * f64::from(duty.as_per_mille()) / 1e3;
    match drive {
        MotorDrive::Open(duty) => (mm(duty), 0.0),
        MotorDrive::Close(duty) => (0.0, mm(duty)),
        MotorDrive::Coast => (0.0, 0.0),
    }
}

pub fn opened_mm(drives: &[MotorDrive]) -> f64 {
    drives.iter().map(|drive| moved_mm(*drive).0).sum()
}

pub fn closed_mm(drive: MotorDrive) -> f64 {
    moved_mm(drive).1
}

/// A fingertip whose pins are set by the test. The converter's noise is +-2 of a 14-bit sample, from a seed.
#[derive(Debug)]
pub struct Bench {
    pub fingertip: Fingertip,
    /// Voltage of every pin, mV.
    pub pins_mv: [f64; COUNT],
    pub events: Vec<Event>,
    pub slows: Vec<Slow>,
    /// Amplitude of a 60 Hz vibration on all films, mV.
    pub vibration_mv: f64,
    /// Largest load that moves between array elements in a slow frame, mV, as under a sliding object.
    pub sliding_mv: f64,
    /// Fluctuation of a contraction, rms, relative to its level above rest.
    pub lively: f64,
    /// Pin of the myosensor whose electrode is off the skin: it does not fluctuate.
    pub lifted: Option<usize>,
    /// Select lines that are stuck low, and those stuck high: bit n is line Sn.
    pub stuck_lines: [u8; 2],
    pub frames: u32,
    samples: LastSamples,
    muscle_noise: ChaCha8Rng,
    wander: [[f64; 2]; 2],
    noise: ChaCha8Rng,
}

impl Bench {
    /// Everything at rest. The line is trusted: what needs consent has tests of its own (`tests/consent.rs`).
    pub fn new(seed: u64) -> Self {
        Self::of(calibrated(), seed)
    }

    pub fn of(fingertip: Fingertip, seed: u64) -> Self {
        Self {
            fingertip,
            pins_mv: relaxed(),
            events: Vec::new(),
            slows: Vec::new(),
            vibration_mv: 0.0,
            sliding_mv: 0.0,
            lively: 0.06,
            lifted: None,
            stuck_lines: [0; 2],
            frames: 0,
            samples: LastSamples::default(),
            muscle_noise: ChaCha8Rng::seed_from_u64(seed ^ 0x0E46),
            wander: [[0.0; 2]; 2],
            noise: ChaCha8Rng::seed_from_u64(seed),
        }
    }

    /// Switched on at rest, then holding something with 4 N and a shear of 0.4 N, long enough for the reflex to watch.
    pub fn holding(seed: u64) -> Self {
        let mut bench = Self::new(seed);
        bench.run(200);
        bench.load(4.0, 0.6);
        bench.run(800);
        assert_eq!(bench.fingertip.mode(), GripMode::Watch);
        bench
    }

    pub fn load(&mut self, normal_n: f64, shear_n: f64) {
        self.load_quadrants(fsr_quadrants_n(normal_n, shear_n, 0.0));
    }

    pub fn load_quadrants(&mut self, newtons: [f64; FSR_COUNT]) {
        for (pin_mv, force_n) in self.pins_mv[FSR..].iter_mut().zip(newtons) {
            *pin_mv = fsr_mv(force_n, f64::powf).min(3_200.0);
        }
    }

    /// An electrode off the skin: a constant envelope, mV above the live zero, instead of its muscle's.
    pub fn lift(&mut self, pin: usize, mv: f64) {
        self.lifted = Some(pin);
        self.pins_mv[pin] = f64::from(MYO_REST_MV) + mv;
    }

    pub fn press(&mut self, mv: f64) {
        self.pins_mv[ARRAY..ARRAY + ARRAY_COUNT].fill(f64::from(CHANNELS[ARRAY].rest_mv) + mv);
    }

    pub fn muscles(&mut self, flexor_mv: f64, extensor_mv: f64) {
        self.pins_mv[MYO_FLEXOR] = f64::from(MYO_REST_MV) + flexor_mv;
        self.pins_mv[MYO_EXTENSOR] = f64::from(MYO_REST_MV) + extensor_mv;
    }

    pub fn frame(&mut self) -> Frame {
        let sequence = self.frames;
        self.frames += 1;
        let phase = f64::from(sequence) * 60.0 / 2_000.0 * TAU;
        let shake_mv = self.vibration_mv * phase.sin();
        if self.sliding_mv > 0.0 && sequence.is_multiple_of(u32::from(FRAMES_PER_SLOW_FRAME)) {
            self.slide();
        }
        let [flexor, extensor] = self.contract();
        let mut pins_mv = self.pins_mv;
        pins_mv[MYO_FLEXOR] = flexor;
        pins_mv[MYO_EXTENSOR] = extensor;
        let mut samples = [0; COUNT];
        for (n, sample) in samples.iter_mut().enumerate() {
            let shake_mv = if (PVDF..PVDF + PVDF_COUNT).contains(&n) { shake_mv } else { 0.0 };
            let exact = i32::from(sample_from_mv((pins_mv[n] + shake_mv).clamp(0.0, 3_300.0).round() as u32));
            *sample = (exact + self.noise.random_range(-2..=2)).clamp(0, i32::from(SAMPLE_MAX)) as u16;
        }
        let mut frame = Frame { valid: true, ..Frame::lost(sequence) };
        frame.pvdf.copy_from_slice(&samples[PVDF..PVDF + PVDF_COUNT]);
        let [low, high] = self.stuck_lines;
        let shown = frame.select() & !low | high;
        let wired = scan_of_pins(&samples, shown);
        frame.switch_a = wired[RANK_SWITCH_A];
        // An input of known voltage.
        frame.switch_b = if shown == HIGH_SELECT { SAMPLE_MAX } else { wired[RANK_SWITCH_B] };
        frame
    }

    /// Voltages of both myosensors' pins, mV. A contraction fluctuates below 6 Hz; the other electrode hears 5 %.
    fn contract(&mut self) -> [f64; 2] {
        const PART: f64 = 0.02;
        const HEARS: f64 = 0.05;
        let own = [MYO_FLEXOR, MYO_EXTENSOR].map(|pin| {
            let wander = &mut self.wander[pin - MYO_FLEXOR];
            wander[0] += PART * (gauss(&mut self.muscle_noise) - wander[0]);
            wander[1] += PART * (wander[0] - wander[1]);
            let above_mv = self.pins_mv[pin] - f64::from(MYO_REST_MV);
            // Two low-passes leave 0.071 of white noise. A broken pin does not fluctuate.
            let moves = above_mv > 0.0 && self.pins_mv[pin] < 3_200.0 && self.lifted != Some(pin);
            let lively = if moves { self.lively } else { 0.0 };
            let mv = self.pins_mv[pin] + above_mv * lively * (wander[1] / 0.071).clamp(-3.0, 3.0);
            let contraction_mv = if moves { (mv - f64::from(MYO_REST_MV) - 50.0).max(0.0) } else { 0.0 };
            (mv, contraction_mv)
        });
        [own[0].0 + HEARS * own[1].1, own[1].0 + HEARS * own[0].1]
    }

    fn slide(&mut self) {
        for giver in ARRAY..ARRAY + ARRAY_COUNT {
            let taker = self.noise.random_range(ARRAY..ARRAY + ARRAY_COUNT);
            let mv = self.noise.random_range(0.0..=self.sliding_mv);
            let [from, to] = [self.pins_mv[giver] - mv, self.pins_mv[taker] + mv];
            if giver != taker && from > 300.0 && to < 3_000.0 {
                (self.pins_mv[giver], self.pins_mv[taker]) = (from, to);
            }
        }
    }

    pub fn step(&mut self) -> MotorDrive {
        let frame = self.frame();
        self.give(&frame)
    }

    pub fn give(&mut self, frame: &Frame) -> MotorDrive {
        let drive = self.fingertip.tick(frame);
        self.samples.record(frame);
        if frame.slot() == slot_of(Job::Think) {
            self.fingertip.think(&self.samples);
            self.fingertip.listen();
        }
        self.slows.extend(self.fingertip.take_slow());
        while let Some(event) = self.fingertip.next_event() {
            self.events.push(event);
        }
        drive
    }

    pub fn run(&mut self, frames: u32) -> Vec<MotorDrive> {
        (0..frames).map(|_| self.step()).collect()
    }

    /// Slips of 0.15 s, one after another: a tone that stands would be noise.
    pub fn run_in_slips(&mut self, frames: u32) {
        for _ in 0..frames / 500 {
            self.vibration_mv = 800.0;
            self.run(300);
            self.vibration_mv = 0.0;
            self.run(200);
        }
    }

    pub fn run_losing(&mut self, places: &[u8], frames: u32) -> Vec<MotorDrive> {
        let give = |_| {
            let frame = self.frame();
            let gone = places.contains(&frame.slot());
            self.give(&if gone { Frame::lost(frame.sequence) } else { frame })
        };
        (0..frames).map(give).collect()
    }

    /// Voltage of a film that hears a tone, mV.
    pub fn hum(&mut self, film: usize, hz: f64, mv: f64) {
        let phase = f64::from(self.frames) * hz / 2_000.0 * TAU;
        self.pins_mv[film] = f64::from(CHANNELS[PVDF].rest_mv) + mv * phase.sin();
    }

    pub fn accepts(&mut self, command: Down) {
        assert_eq!(self.fingertip.command(&command), Ok(()), "{command:?}");
    }

    pub fn press_button(&mut self, frames: u32) -> Vec<MotorDrive> {
        self.fingertip.button(true);
        let mut drives = self.run(frames);
        self.fingertip.button(false);
        drives.extend(self.run(200));
        drives
    }

    pub fn kinds(&self) -> impl Iterator<Item = EventKind> {
        self.events.iter().map(|event| event.kind)
    }

    pub fn count(&self, kind: EventKind) -> usize {
        self.kinds().filter(|other| *other == kind).count()
    }

    pub fn lost(&self, channel: usize) -> Vec<(u32, Reason)> {
        let lost = self.events.iter().filter_map(|event| match event.kind {
            EventKind::Fault(Fault::SensorLost { channel: lost, reason }) if usize::from(lost) == channel => {
                Some((event.frame, reason))
            }
            _ => None,
        });
        lost.collect()
    }

    pub fn ticks(&self) -> impl Iterator<Item = &TickRecord> {
        self.slows.iter().flat_map(|slow| &slow.ticks)
    }

    pub fn by_reflex(&self) -> usize {
        self.ticks().filter(|tick| tick.source == DriveSource::Reflex).count()
    }

    pub fn causes(&self) -> Vec<Cause> {
        let cause = |kind| if let EventKind::Mode { cause, .. } = kind { Some(cause) } else { None };
        self.kinds().filter_map(cause).collect()
    }
}
