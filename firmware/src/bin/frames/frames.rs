//! What each of the other detectors takes of the core in a frame: its sensors' conditioning, itself, and plain rivals.

use core::hint::black_box;
use core::sync::atomic::{AtomicU16, AtomicU32, Ordering::Relaxed};

use tenax_hal_shim::channel::{FSR, FSR_COUNT, PVDF_COUNT, SCAN_LEN, STRAIN};
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::schedule::SCHEDULE;
use tenax_hal_shim::wire::Forces;
use tenax_logic::array::{FEATURES, Features, Preprocessor, Reading, shipped};
use tenax_logic::config::Config;
use tenax_logic::detectors::{Detector, Said, Sensed};
use tenax_logic::force::settings::FrictionConfig;
use tenax_logic::force::{ForceSensor, FrictionDetector};
use tenax_logic::hebbian::HebbianDetector;
use tenax_logic::hebbian::settings::HebbianConfig;
use tenax_logic::journal::Journal;
use tenax_logic::samples::LastSamples;
use tenax_logic::senses::Senses;
use tenax_logic::strain::Gauges;
use tenax_logic::vibration::detector::S1;
use tenax_logic::vibration::quality::PvdfQuality;
use tenax_logic::vibration::settings::VibrationConfig;
use tenax_logic::vibration::{Vibration, VibrationDetector};

use crate::Detector as Mlp;
use crate::rivals::{Loudness, logit, ratio_permille};

/// Features of the paper.
const OF_PAPER: usize = 76;

/// Of kernels that keep something: its state and its constants, bytes. The host knows them in this order: films, gauges, force, s1, s2,
/// hebbian, slow_frame, loudness, features, logistic_112, logistic_76, ratio.
#[unsafe(no_mangle)]
static TENAX_KERNELS_BYTES: [[u32; 2]; 12] = [
    [(size_of::<PvdfQuality>() + size_of::<VibrationDetector>()) as u32, 0],
    [size_of::<Gauges>() as u32, 0],
    [size_of::<ForceSensor>() as u32, 0],
    [size_of::<S1>() as u32, 0],
    [size_of::<FrictionDetector>() as u32, 0],
    [size_of::<HebbianDetector>() as u32, 0],
    [size_of::<Mlp>() as u32, size_of_val(&shipped::MODEL) as u32],
    [size_of::<Loudness>() as u32, 0],
    [size_of::<Preprocessor>() as u32, 0],
    [0, (4 * FEATURES + 4) as u32],
    [0, (4 * OF_PAPER + 4) as u32],
    [0, 0],
];

/// From the host: whether there is a frame and no reading.
#[unsafe(no_mangle)]
static TENAX_KERNELS_COMES: AtomicU32 = AtomicU32::new(0);
/// From the host: one frame, the films and what both switches show.
#[unsafe(no_mangle)]
static TENAX_KERNELS_FRAME: [AtomicU16; SCAN_LEN] = [const { AtomicU16::new(0) }; SCAN_LEN];

/// The frame that the host has put there, if it has.
pub fn comes() -> Option<[u16; SCAN_LEN]> {
    let comes = TENAX_KERNELS_COMES.load(Relaxed) != 0;
    comes.then(|| TENAX_KERNELS_FRAME.each_ref().map(|sample| sample.load(Relaxed)))
}

/// Their state.
#[derive(Default)]
pub struct Frames {
    config: Config,
    senses: Senses,
    last: LastSamples,
    journal: Journal,
    quality: PvdfQuality,
    films: VibrationDetector,
    gauges: Gauges,
    force: ForceSensor,
    quadrants: [u16; FSR_COUNT],
    s1: S1,
    s2: FrictionDetector,
    hebbian: HebbianDetector,
    loudness: Loudness,
    features: Preprocessor,
    sequence: u32,
}

impl Frames {
    /// Takes a frame's samples and runs each kernel that has something to do in it.
    #[inline(never)]
    pub fn run(&mut self, samples: &[u16; SCAN_LEN]) {
        black_box(&TENAX_KERNELS_BYTES);
        let mut frame = Frame { valid: true, ..Frame::lost(self.sequence) };
        self.sequence = self.sequence.wrapping_add(1);
        frame.pvdf.copy_from_slice(&samples[..PVDF_COUNT]);
        (frame.switch_a, frame.switch_b) = (samples[PVDF_COUNT], samples[PVDF_COUNT + 1]);
        black_box(tenax_kernel_films(
            &mut self.quality,
            &mut self.films,
            &self.config.vibration,
            &frame.pvdf,
        ));
        black_box(tenax_kernel_loudness(&mut self.loudness, &frame.pvdf));
        let shown = SCHEDULE[usize::from(frame.slot())].switch_a.map_or(usize::MAX, usize::from);
        if (STRAIN..FSR).contains(&shown) {
            tenax_kernel_gauges(&mut self.gauges, shown - STRAIN, frame.switch_a);
        }
        if let Some(quadrant) = self.quadrants.get_mut(shown.wrapping_sub(FSR)) {
            *quadrant = frame.switch_a;
            if shown == FSR + FSR_COUNT - 1 {
                let loaded_mn = self.config.friction.loaded_mn;
                if let Some(forces) = tenax_kernel_force(&mut self.force, self.quadrants, loaded_mn) {
                    black_box(tenax_kernel_ratio(forces.ft_mn, forces.load_mn));
                }
            }
        }
        self.journal.begin(&frame);
        self.senses.process(&self.config, &frame, &mut self.journal);
        self.last.record(&frame);
        let sensed = self.senses.sensed(&self.config, &frame, 0, false);
        black_box(tenax_kernel_s1(&mut self.s1, &self.config.vibration, &sensed));
        black_box(tenax_kernel_s2(&mut self.s2, &self.config.friction, &sensed));
        black_box(tenax_kernel_hebbian(&mut self.hebbian, &self.config.hebbian, &sensed));
        if frame.ends_slow_frame() {
            self.senses.think(&self.config, &self.last, &mut self.journal);
            let reading = *sensed_taxels(&self.senses, &self.config, &frame);
            if tenax_kernel_features(&mut self.features, &reading) {
                let weights = black_box([3; FEATURES]);
                let features = self.features.features();
                black_box(tenax_kernel_logistic_112(&weights, features));
                if let (Some(weights), Some(features)) = (weights.first_chunk(), features.first_chunk()) {
                    black_box(tenax_kernel_logistic_76(weights, features));
                }
            }
            let _told = self.journal.take_slow();
        }
        while self.journal.next_event().is_some() {}
    }
}

#[inline(never)]
fn sensed_taxels<'a>(senses: &'a Senses, config: &Config, frame: &Frame) -> &'a Reading {
    senses.sensed(config, frame, 0, false).taxels
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_films(
    quality: &mut PvdfQuality,
    films: &mut VibrationDetector,
    config: &VibrationConfig,
    pvdf: &[u16; PVDF_COUNT],
) -> Vibration {
    let trusts = quality.check(pvdf, |_, _| ());
    films.process(config, pvdf, trusts.as_ref())
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_gauges(gauges: &mut Gauges, gauge: usize, sample: u16) {
    let _change = gauges.read(gauge, sample, false);
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_force(force: &mut ForceSensor, samples: [u16; FSR_COUNT], loaded_mn: i32) -> Option<Forces> {
    force.process(samples, loaded_mn, false)
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_s1(s1: &mut S1, config: &VibrationConfig, sensed: &Sensed<'_>) -> Option<Said> {
    s1.step(config, sensed)
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_s2(s2: &mut FrictionDetector, config: &FrictionConfig, sensed: &Sensed<'_>) -> Option<Said> {
    s2.step(config, sensed)
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_hebbian(
    hebbian: &mut HebbianDetector,
    config: &HebbianConfig,
    sensed: &Sensed<'_>,
) -> Option<Said> {
    hebbian.step(config, sensed)
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_loudness(loudness: &mut Loudness, pvdf: &[u16; PVDF_COUNT]) -> i32 {
    loudness.step(pvdf)
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_ratio(ft_mn: i32, fn_mn: i32) -> i32 {
    ratio_permille(ft_mn, fn_mn)
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_features(features: &mut Preprocessor, reading: &Reading) -> bool {
    features.push(reading).is_some()
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_logistic_112(weights: &[i32; FEATURES], features: &Features) -> i32 {
    logit(weights, 0, features)
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_logistic_76(weights: &[i32; OF_PAPER], features: &[i16; OF_PAPER]) -> i32 {
    logit(weights, 0, features)
}
