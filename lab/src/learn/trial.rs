//! One pick-up (Tada 2006, figure 5), and what is read off it.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_logic::detectors::Said;
use tenax_scene::sensor::camera::Seen;
use tenax_scene::truth::Slip;
use tenax_scene::{SceneFile, Seeds, Truth, World};

use super::finger::Finger;
use tenax_sim::report::fate;
use tenax_sim::scorer::{Card, Doing, Outcome, Stretch, Verdict, outcome};

const SCENE: &str = "pick-up-trial";
/// When its arm begins to lift, at the earliest, s. Chance adds up to six of the camera's images, so that no image has a
/// favourite instant.
const LIFT_S: f64 = 1.2;
const LATER_S: f64 = 0.2;

#[derive(Debug)]
pub struct Setup {
    pub world: World,
    /// When the arm begins to lift, s.
    pub lift_s: f64,
}

impl Setup {
    /// A trial of this finger. The seed decides all that differs from one trial to the next. A lesson is one in which the
    /// camera teaches. Fails if the scene cannot be made.
    pub fn new(finger: &Finger, seed: u64, lesson: bool) -> anyhow::Result<Self> {
        let (scene, lift_s) = Self::scene(finger, seed, lesson)?;
        Ok(Self { world: World::seeded(&scene, Seeds { making: finger.making, noise: seed }), lift_s })
    }

    /// Its scene, and when the arm begins to lift, s. Fails if the scene cannot be made.
    pub fn scene(finger: &Finger, seed: u64, lesson: bool) -> anyhow::Result<(SceneFile, f64)> {
        let lift_s = LIFT_S + ChaCha8Rng::seed_from_u64(seed).random_range(0.0..LATER_S);
        let scene = finger.scene(SCENE, seed, &[("move.0.at_s", lift_s)], |scene| {
            if let Some(camera) = scene.get_mut("camera").and_then(toml::Value::as_table_mut) {
                camera.insert("teaches".to_owned(), lesson.into());
            }
        })?;
        Ok((scene, lift_s))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Word {
    /// Slip or a warning of it, whichever comes first.
    Any,
    /// Slip: the films hear it.
    Slip,
    /// A warning: shear foretells it.
    Warning,
}

impl Word {
    pub const fn is_in(self, said: Said) -> bool {
        match self {
            Self::Any => said.slip || said.incipient,
            Self::Slip => said.slip,
            Self::Warning => said.incipient,
        }
    }
}

/// A trial that was run: what the fingertip said in every tick, and what was true.
#[derive(Clone, Debug, Default)]
pub struct Trial {
    pub lift_s: f64,
    pub outputs: Vec<[i8; 2]>,
    /// Whether that meant slip, and whether it was warned of.
    pub said: Vec<Said>,
    pub truth: Truth,
}

impl Trial {
    pub fn time_s(tick: usize) -> f64 {
        (tick as f64 + 1.0) / f64::from(FRAME_HZ)
    }

    fn slips_since_lift(&self) -> impl DoubleEndedIterator<Item = &Slip> {
        self.truth.slips.iter().filter(|slip| !slip.meant && slip.macro_onset_s > self.lift_s)
    }

    /// The slip up, if there was one.
    pub fn slip_up(&self) -> Option<Slip> {
        self.slips_since_lift().next().copied()
    }

    /// The slips that were not meant: up, then down.
    pub fn both_slips(&self) -> Option<[Slip; 2]> {
        let up = self.slip_up()?;
        // A long slip is the one that is meant here; a slide of a fraction of a millimetre before or after is part of it.
        let down = *self.slips_since_lift().rfind(|slip| slip.macro_onset_s > up.macro_onset_s)?;
        Some([up, down])
    }

    /// The stretches in which the network said this.
    pub fn verdicts(&self, word: Word) -> Vec<Verdict> {
        let mut all: Vec<Verdict> = Vec::new();
        for (tick, &said) in self.said.iter().enumerate() {
            Verdict::go_on(&mut all, Self::time_s(tick), word.is_in(said));
        }
        all
    }

    /// When the network first said this in the slip up, in time or late, s.
    pub fn said_s(&self, word: Word) -> Option<f64> {
        let up = self.slip_up()?;
        let span =
            fate::spans(&self.truth).into_iter().find(|span| span.macro_onset_s == Some(up.macro_onset_s))?;
        match outcome(&span, up.macro_onset_s, &self.verdicts(word)) {
            Outcome::Caught(latency_s) | Outcome::Late(latency_s) => Some(up.macro_onset_s + latency_s),
            Outcome::SaidBefore | Outcome::Missed => None,
        }
    }

    /// The event scores of the trial, from its beginning to the end of the slip down. What rubs afterwards stands on the table.
    pub fn card(&self, word: Word) -> Card {
        let Some([_, down]) = self.both_slips() else { return Card::default() };
        let to_s = down.end_s.unwrap_or(f64::INFINITY).min(Self::time_s(self.said.len()));
        let whole = Stretch { from_s: 0.0, to_s, doing: Doing::Move };
        Card::of(&fate::spans(&self.truth), &self.verdicts(word), &[whole])
    }

    /// The camera's first v1 = -1 after the lift began.
    pub fn first_seen(&self) -> Option<&Seen> {
        self.truth.camera.iter().find(|seen| seen.v1 < 0 && seen.t_s > self.lift_s)
    }

    /// The mean direction of o2 in a slip, -1 to 1.
    pub fn direction(&self, slip: &Slip) -> f64 {
        let tick = |t_s: f64| ((t_s * f64::from(FRAME_HZ)) as usize).min(self.outputs.len());
        let said = &self.outputs[tick(slip.macro_onset_s)..tick(slip.end_s.unwrap_or(f64::INFINITY))];
        said.iter().map(|outputs| f64::from(outputs[1])).sum::<f64>() / (128.0 * said.len().max(1) as f64)
    }
}
