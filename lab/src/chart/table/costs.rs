//! Processor time of each row's parts on this PC, side by side over one pour.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::hint::black_box;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

use tenax_frames::quantile::middle;
use tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME;
use tenax_logic::array::{FEATURES, Preprocessor, ShippedDetector};
use tenax_logic::config::Config;
use tenax_logic::detectors::Detector;
use tenax_logic::force::FrictionDetector;
use tenax_logic::hebbian::HebbianDetector;
use tenax_logic::vibration::detector::S1;

use super::heard::{Felt, Judge, Plan};
use super::rivals::{self, Logistic, OF_PAPER, Score};

/// Steps of a part in each frame: reading the clock takes as long as a small part.
const COPIES: usize = 16;
const PLAN: Plan = Plan { seed: 25_001, fingers: 1, pours: 1, picks: 0, minutes: 0 };

/// Mean time of a frame of 0.5 ms, ns, by part.
#[derive(Clone, Debug, Default)]
pub struct Costs(pub BTreeMap<&'static str, f64>);

/// A part's state, as a step of one frame.
type Step = Box<dyn FnMut(&Felt<'_>)>;
/// A part's name, and fresh states of it.
type Part = (&'static str, Box<dyn Fn() -> Step>);

impl Costs {
    /// The sum of these parts. None if one was not measured.
    pub fn of(&self, parts: &[&str]) -> Option<f64> {
        parts.iter().map(|part| self.0.get(part)).sum()
    }

    /// Measures every part. Fails if the scene cannot be made.
    pub fn measured() -> anyhow::Result<Self> {
        let fingertip = PLAN.fingertip(0, true)?;
        let parts = parts(fingertip.network()?);
        let spent: Vec<Rc<RefCell<Vec<f64>>>> = (0..=parts.len()).map(|_| Rc::default()).collect();
        let judges = || {
            let copies = parts.iter().map(|(_, make)| (0..COPIES).map(|_| make()).collect());
            // The last is the clock alone.
            let copies = copies.chain([Vec::new()]);
            copies.zip(&spent).map(|(copies, spent)| timed(copies, Rc::clone(spent))).collect()
        };
        fingertip.record(&PLAN, &judges, &mut |_| ())?;
        // The median over slow frames, which another program's turn of the processor does not move.
        let ns = |n: usize| middle(spent[n].take()).unwrap_or_default();
        let clock_ns = ns(parts.len());
        let costs = parts.iter().enumerate();
        Ok(Self(
            costs.map(|(n, (name, _))| (*name, ((ns(n) - clock_ns) / COPIES as f64).max(0.01))).collect(),
        ))
    }
}

/// Runs these and keeps their mean time of a frame in each slow frame, ns.
fn timed(mut copies: Vec<Step>, spent: Rc<RefCell<Vec<f64>>>) -> Judge {
    let mut own = Duration::ZERO;
    Box::new(move |felt| {
        let begin = Instant::now();
        copies.iter_mut().for_each(|step| step(felt));
        own += begin.elapsed();
        if felt.frame.ends_slow_frame() {
            let ns = std::mem::take(&mut own).as_secs_f64() * 1e9;
            spent.borrow_mut().push(ns / f64::from(FRAMES_PER_SLOW_FRAME));
        }
        false
    })
}

fn parts(network: HebbianDetector) -> Vec<Part> {
    let linear = |count| {
        let own = Arc::new(Logistic { weights: vec![1; count], bias: 0 });
        move || score(rivals::logistic(Arc::clone(&own)))
    };
    vec![
        ("s1", Box::new(|| detector(S1::default(), |config| &config.vibration))),
        ("s2", Box::new(|| detector(FrictionDetector::default(), |config| &config.friction))),
        ("hebbian", Box::new(move || detector(network.clone(), |config| &config.hebbian))),
        ("mlp", Box::new(|| detector(ShippedDetector::default(), |_| &()))),
        ("features", Box::new(features)),
        ("loudness", Box::new(|| score(rivals::loudness()))),
        ("ratio", Box::new(|| score(rivals::ratio()))),
        ("logistic_112", Box::new(linear(FEATURES))),
        ("logistic_76", Box::new(linear(OF_PAPER))),
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

fn score(mut score: Score) -> Step {
    Box::new(move |felt| {
        black_box(score(felt));
    })
}
