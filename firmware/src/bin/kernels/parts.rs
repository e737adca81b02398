//! The parts of the detector, each by itself, and a sample of the photoelastic head.

use core::hint::black_box;

use tenax_logic::array::covariance::SlidingCovariance;
use tenax_logic::array::logarithm::Knee;
use tenax_logic::array::past::Past;
use tenax_logic::array::spectrum::SlidingSpectrum;
use tenax_logic::array::structure::{self, STRUCTURES, Structure, WINDOWS};
use tenax_logic::array::{BINS, ELEMENTS, FEATURES, Features, Mlp, PreprocessorConfig, Reading, shipped};
use tenax_logic::photoelastic::{Head, HeadConfig};

/// Their state.
pub struct Parts {
    covariance: SlidingCovariance<10>,
    spectrum: SlidingSpectrum<40>,
    past: Past,
    structure: Structure,
    knees: [Knee; WINDOWS],
    head: Head,
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
