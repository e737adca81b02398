//! Processor time of each row's parts on this PC, side by side in one process.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use tenax_frames::quantile::middle;
use tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME;
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::MotorDrive;
use tenax_logic::array::{Preprocessor, ShippedDetector};
use tenax_logic::config::Config;
use tenax_logic::detectors::Detector;
use tenax_logic::force::FrictionDetector;
use tenax_logic::hebbian::HebbianDetector;
use tenax_logic::vibration::detector::S1;

use super::heard::{Ears, Felt, Fingertip, Judge, Plan};
use super::rivals::{self, Logistic};

/// Steps of a part in each frame: reading the clock takes as long as a small part.
const COPIES: usize = 16;
/// Runs over the recording; the median counts.
const REPEATS: usize = 5;

/// Mean time of a frame of 0.5 ms, ns, by part.
#[derive(Clone, Debug, Default)]
pub struct Costs(pub BTreeMap<&'static str, f64>);

/// A part's state, as a step of one frame.
type Step = Box<dyn FnMut(&Felt<'_>)>;

impl Costs {
    /// The sum of these parts. None if one was not measured.
    pub fn of(&self, parts: &[&str]) -> Option<f64> {
        parts.iter().map(|part| self.0.get(part)).sum()
    }

    /// Measures every part on a pour of the table's kind: 26 s. Fails if the scene cannot be made.
    pub fn measured() -> anyhow::Result<Self> {
        let fingertip = PLAN.fingertip(0, true)?;
        let frames = pour(&fingertip)?;
        let parts = parts(fingertip.network()?);
        // The parts take turns, so that a slow second of the machine is nobody's alone.
        let mut all: BTreeMap<&'static str, Vec<f64>> = BTreeMap::new();
        for _ in 0..REPEATS {
            let bare_ns = run(&frames, Vec::new())?;
            for (name, make) in &parts {
                let copies = (0..COPIES).map(|_| make()).collect();
                let ns = (run(&frames, copies)? - bare_ns) / COPIES as f64;
                all.entry(*name).or_default().push(ns.max(0.01));
            }
        }
        Ok(Self(all.into_iter().filter_map(|(name, all)| Some((name, middle(all)?))).collect()))
    }
}

/// A part's name, and fresh states of it.
type Part = (&'static str, Box<dyn Fn() -> Step>);

fn parts(network: HebbianDetector) -> Vec<Part> {
    let logistic = |count| rivals::logistic(Logistic { weights: vec![1; count], bias: 0 });
    vec![
        ("s1", Box::new(|| detector(S1::default(), |config| &config.vibration))),
        ("s2", Box::new(|| detector(FrictionDetector::default(), |config| &config.friction))),
        ("hebbian", Box::new(move || detector(network.clone(), |config| &config.hebbian))),
        ("mlp", Box::new(|| detector(ShippedDetector::default(), |_| &()))),
        ("features", Box::new(features)),
        ("loudness", Box::new(|| judge(rivals::loudness()))),
        ("ratio", Box::new(|| judge(rivals::ratio()))),
        ("logistic_112", Box::new(move || judge(logistic(112)))),
        ("logistic_76", Box::new(move || judge(logistic(76)))),
    ]
}

fn features() -> Step {
    let mut features: Preprocessor = Preprocessor::default();
    Box::new(move |felt| {
        if felt.features.is_some() {
            black_box(features.push(felt.sensed.taxels));
        }
    })
}

fn detector<D: Detector + 'static>(mut detector: D, settings: fn(&Config) -> &D::Config) -> Step {
    let config = Config::default();
    Box::new(move |felt| {
        black_box(detector.step(settings(&config), felt.sensed));
    })
}

fn judge(mut judge: Box<dyn Judge>) -> Step {
    Box::new(move |felt| {
        black_box(judge.hear(felt));
    })
}

/// Mean time of these steps in a frame, ns: the median over slow frames, which another program's turn of the processor does not move.
fn run(frames: &[Frame], mut steps: Vec<Step>) -> anyhow::Result<f64> {
    let mut ears = Ears::new(&[])?;
    let mut cycles = Vec::new();
    for cycle in frames.chunks_exact(usize::from(FRAMES_PER_SLOW_FRAME)) {
        let mut spent = Duration::ZERO;
        for frame in cycle {
            ears.take(frame, MotorDrive::Coast, &mut |felt| {
                let begin = Instant::now();
                steps.iter_mut().for_each(|step| step(felt));
                spent += begin.elapsed();
            });
        }
        cycles.push(spent.as_secs_f64() * 1e9 / cycle.len() as f64);
    }
    Ok(middle(cycles).unwrap_or_default())
}

/// One pour of one fingertip.
const PLAN: Plan = Plan { seed: 25_001, fingers: 1, pours: 1, picks: 0, minutes: 0 };

fn pour(fingertip: &Fingertip) -> anyhow::Result<Vec<Frame>> {
    struct Keeps(Arc<Mutex<Vec<Frame>>>);
    impl Judge for Keeps {
        fn hear(&mut self, felt: &Felt<'_>) -> bool {
            self.0.lock().unwrap_or_else(PoisonError::into_inner).push(*felt.frame);
            false
        }
    }
    let kept = Arc::new(Mutex::new(Vec::new()));
    let rows = || -> Vec<Box<dyn Judge>> { vec![Box::new(Keeps(Arc::clone(&kept)))] };
    fingertip.record(&PLAN, &rows, &mut |_, _| (), &mut || ())?;
    Ok(std::mem::take(&mut *kept.lock().unwrap_or_else(PoisonError::into_inner)))
}
