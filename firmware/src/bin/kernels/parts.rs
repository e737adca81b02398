//! The parts of the detector, each by itself, a sample of the photoelastic head, and what a hand of several fingertips takes.

use core::hint::black_box;

use tenax_hal_shim::wire::{Receiver, encode};
use tenax_logic::array::covariance::SlidingCovariance;
use tenax_logic::array::logarithm::Knee;
use tenax_logic::array::past::Past;
use tenax_logic::array::spectrum::SlidingSpectrum;
use tenax_logic::array::structure::{self, STRUCTURES, Structure, WINDOWS};
use tenax_logic::array::{BINS, ELEMENTS, FEATURES, Features, Mlp, PreprocessorConfig, Reading, shipped};
use tenax_logic::photoelastic::{Head, HeadConfig};
use tenax_palm::bus::{ALL, FINGERS_MAX, FRAME_MAX, Packet, Poll, Word};
use tenax_palm::finger::{Answer, Finger};
use tenax_palm::share::{Contact, Forces, load, share};

/// Their state.
pub struct Parts {
    covariance: SlidingCovariance<10>,
    spectrum: SlidingSpectrum<40>,
    past: Past,
    structure: Structure,
    knees: [Knee; WINDOWS],
    head: Head,
    finger: Finger,
    number: u16,
}

impl Default for Parts {
    fn default() -> Self {
        let config = PreprocessorConfig::DEFAULT;
        Self {
            covariance: SlidingCovariance::default(),
            spectrum: SlidingSpectrum::default(),
            past: Past::default(),
            structure: Structure::default(),
            knees: structure::knees(config.structure_knee),
            head: Head::default(),
            finger: Finger::new([1, 2, 3]),
            number: 0,
        }
    }
}

impl Parts {
    /// Runs each of them once. Numbers of the reading stand in for differences: what they are costs nothing.
    pub fn run(&mut self, reading: &Reading, features: &Features) {
        let numbers = reading.map(|sample| i32::from(sample.unwrap_or(0)));
        tenax_kernel_covariance(&mut self.covariance, &numbers);
        black_box(self.covariance.entries());
        black_box(tenax_kernel_spectrum(&mut self.spectrum, numbers.iter().sum()));
        self.past.push(reading);
        black_box(tenax_kernel_structure(&mut self.structure, &self.past, &self.knees));
        black_box(tenax_kernel_mlp_structure_8_1(black_box(&shipped::MODEL.network), features));
        let config = HeadConfig { slip: 10, ..HeadConfig::default() };
        // One of ten, so that it is called from one place.
        if let Some(sample) = reading[0] {
            tenax_kernel_head_sample(&mut self.head, &config, sample);
        }
        black_box(tenax_kernel_palm_share(&black_box(hand(&numbers))));
        self.poll();
    }

    /// A poll of the palm's, and its answer with as many bytes of the line as there is room for.
    fn poll(&mut self) {
        let (mut frame, mut out) = ([0; FRAME_MAX], [0; FRAME_MAX]);
        if self.finger.address() == ALL {
            self.claim();
        }
        self.finger.post(&[7; 64]);
        self.number = self.number.wrapping_add(1);
        let poll = Poll {
            stamp_us: 2_000 * u32::from(self.number),
            slips: 1,
            want_mn: Some(9_000),
            ..Poll::default()
        };
        let packet = Packet { address: 1, word: Word::Poll(poll) };
        if let Some(frame) = encode(self.number, &packet, &mut frame) {
            black_box(tenax_kernel_bus_poll(&mut self.finger, black_box(frame), &mut out));
        }
    }

    /// It says who it is, and is given an address.
    fn claim(&mut self) {
        let (mut frame, mut out) = ([0; FRAME_MAX], [0; FRAME_MAX]);
        let claim = Packet { address: ALL, word: Word::Claim { round: 1, slots: 1 } };
        let Some(asked) = encode(0, &claim, &mut frame) else { return };
        let Some(answer) = asked.iter().find_map(|&byte| self.finger.hear(byte, 0, &mut out)) else { return };
        let mut receiver = Receiver::new();
        let mut said = out.iter().take(answer.length);
        let Some(Ok(here)) = said.find_map(|&byte| receiver.push::<Packet>(byte)) else { return };
        if let Word::Here { chip, nonce } = here.message.word {
            let assign = Packet { address: 1, word: Word::Assign { chip, nonce } };
            if let Some(frame) = encode(self.number, &assign, &mut frame) {
                frame.iter().for_each(|&byte| _ = self.finger.hear(byte, 0, &mut out));
            }
        }
    }
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_covariance(covariance: &mut SlidingCovariance<10>, differences: &[i32; ELEMENTS]) {
    covariance.push(differences);
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_spectrum(spectrum: &mut SlidingSpectrum<40>, sum: i32) -> [f32; BINS] {
    spectrum.push(sum);
    spectrum.powers()
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_structure(
    structure: &mut Structure,
    past: &Past,
    knees: &[Knee; WINDOWS],
) -> [i16; STRUCTURES] {
    structure.push(past);
    let mut features = [0; STRUCTURES];
    structure.compress(knees, &mut features);
    features
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_mlp_structure_8_1(network: &Mlp<FEATURES, 32, 1, 16>, features: &Features) -> i32 {
    network.judge(&[network.see(features)])
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_head_sample(head: &mut Head, config: &HeadConfig, sample: u16) {
    // Its faults are another kernel's.
    let _change = head.process(config, sample);
}

/// A thumb and four fingers, whose needs are these numbers.
fn hand(numbers: &[i32; ELEMENTS]) -> [Contact; FINGERS_MAX] {
    let normals = [[1_000, 0], [-914, 407], [-990, 139], [-990, -139], [-914, -407]];
    core::array::from_fn(|n| Contact { normal: normals[n], least_mn: numbers[n], most_mn: 40_000 })
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_palm_share(hand: &[Contact; FINGERS_MAX]) -> Option<Forces> {
    share(hand, load(hand, &hand.map(|contact| contact.least_mn)))
}

/// Hears a poll byte by byte, and writes its answer.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_bus_poll(finger: &mut Finger, frame: &[u8], out: &mut [u8]) -> Option<Answer> {
    frame.iter().find_map(|&byte| finger.hear(byte, 0, out))
}
