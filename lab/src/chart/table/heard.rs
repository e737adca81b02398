//! The input of every row of the table: the same fingertips, scenes and noise, sample by sample, while nobody's reflex moves the hand.

use anyhow::Context;
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use tenax_hal_shim::channel::{ARRAY_COUNT, FRAMES_PER_SLOW_FRAME, frames};
use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::Down;
use tenax_hal_shim::words::GripMode;
use tenax_logic::array::{Features, Preprocessor, Reading};
use tenax_logic::config::Config;
use tenax_logic::detectors::{Detectors, Sensed, WEIGHED};
use tenax_logic::hebbian::HebbianDetector;
use tenax_logic::journal::Journal;
use tenax_logic::samples::LastSamples;
use tenax_logic::senses::Senses;
use tenax_scene::plant::Plant;
use tenax_scene::{SceneFile, Seeds, World};

use crate::dataset::operator::Operator;
use crate::dataset::session::{self, Session, Sizes};
use crate::dataset::story::Story;
use crate::learn::finger::Finger;
use crate::learn::{self, holding};
use tenax_sim::report::fate;
use tenax_sim::scorer::{SlipSpan, Verdict};

/// When the operator of a pick lets go, s: what slides after that is meant.
const LETS_GO_S: f64 = 7.3;
/// The empty hand's forces are zeroed at this frame.
const ZEROED_AT: u32 = frames(100);

/// A row's input in one frame (0.5 ms).
pub struct Felt<'a> {
    pub frame: &'a Frame,
    pub sensed: &'a Sensed<'a>,
    /// The detectors of the image that report slip or warn of it, and are believed.
    pub believed: DetectorSet,
    /// The array's features, in the frames that bring new ones.
    pub features: Option<&'a Features>,
    /// Whether the object slid in most frames since the last features.
    pub slides: bool,
}

/// Takes a frame: whether it says slip now.
pub type Judge = Box<dyn FnMut(&Felt<'_>) -> bool>;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Balls are poured into a box until it slips, again and again; a box is picked up, too loosely as often as not.
    Slips,
    /// A minute of firm holding.
    Quiet,
    Disturbed,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Heard {
    pub finger: u64,
    pub kind: Kind,
    /// The scored span, s.
    pub span_s: (f64, f64),
    pub slips: Vec<SlipSpan>,
    /// Of each judge.
    pub said: Vec<Vec<Verdict>>,
}

#[derive(Clone, Copy, Debug)]
pub struct Plan {
    pub seed: u64,
    /// Fingertips with each of four kinds of surface.
    pub fingers: usize,
    pub pours: u64,
    pub picks: u64,
    /// Minutes of quiet, and as many with disturbances.
    pub minutes: u64,
}

/// A fingertip: its films, gauges and array, what it holds, and its network.
pub struct Fingertip {
    number: u64,
    finger: Finger,
    session: Session,
    /// Snapshot of the taught network.
    taught: Option<Vec<u8>>,
}

impl Plan {
    /// The fingertips, each taught in its own lessons if the network is asked. Friction, films, gauges and array are drawn over about a
    /// decade each. Fails if a lesson cannot be made.
    pub fn fingertip(&self, n: usize, taught: bool) -> anyhow::Result<Fingertip> {
        let sizes = Sizes { train: self.fingers, validation: 0, test: 0 };
        let mut session = session::sessions(self.seed, sizes).swap_remove(n);
        let number = self.seed.wrapping_mul(1_000).wrapping_add(n as u64);
        let finger = Finger::random(number);
        [session.mu_s, session.mu_d] = finger.friction();
        let taught = taught.then(|| learn::taught(&finger, number)?.snapshot()).transpose()?;
        Ok(Fingertip { number, finger, session, taught })
    }

    pub const fn count(&self) -> usize {
        4 * self.fingers
    }
}

impl Fingertip {
    /// The taught network. Fails if it was not taught.
    pub fn network(&self) -> anyhow::Result<HebbianDetector> {
        let mut network = HebbianDetector::default();
        let taught = self.taught.as_ref().context("nothing was taught")?;
        network.restore(taught).then_some(network).context("a snapshot that is damaged")
    }

    /// Its recordings, one after the other; `judges` gives fresh ones for each. Fails if a scene cannot be made.
    pub fn record(
        &self,
        plan: &Plan,
        judges: &dyn Fn() -> Vec<Judge>,
        done: &mut dyn FnMut(f64),
    ) -> anyhow::Result<Vec<Heard>> {
        let mut all = Vec::new();
        let count = (plan.pours + plan.picks + 2 * plan.minutes) as f64;
        let empty =
            |kind, span_s| Heard { finger: self.number, kind, span_s, slips: Vec::new(), said: Vec::new() };
        let stories = [(Story::Pour, plan.pours), (Story::Pick, plan.picks)];
        for (story, n) in stories.into_iter().flat_map(|(story, count)| (0..count).map(move |n| (story, n))) {
            let seed = self.number.wrapping_mul(1_000) + 100 * story as u64 + n;
            let session = Session { seed, ..self.session.clone() };
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let scene = story.scene_in(&session, &mut rng, |scene| self.finger.put_on(scene))?;
            let mut operator = Operator::new(story, &session, ChaCha8Rng::seed_from_u64(rng.random()));
            let mut drive = |world: &World, _: &[Down]| operator.drive(world, world.slipping());
            let end_s = if story == Story::Pick { LETS_GO_S } else { scene.duration_s() };
            let heard = empty(Kind::Slips, (0.0, end_s));
            all.push(self.hear(&scene, seed, heard, &mut drive, judges())?);
            done(all.len() as f64 / count);
        }
        let kinds = [Kind::Quiet, Kind::Disturbed];
        for (n, kind) in (0..plan.minutes).flat_map(|n| kinds.map(|kind| (n, kind))) {
            let seed = self.number.wrapping_mul(1_000) + 900 + n;
            let scene = holding::minute(&self.with_array(), seed, kind == Kind::Disturbed)?;
            let mut line = Line::default();
            let mut drive = |_: &World, commands: &[Down]| line.drive(commands);
            let heard = empty(kind, (holding::FROM_S, scene.duration_s()));
            all.push(self.hear(&scene, seed, heard, &mut drive, judges())?);
            done(all.len() as f64 / count);
        }
        Ok(all)
    }

    /// The finger, with the session's array in its scenes.
    fn with_array(&self) -> Finger {
        let is_array = |(place, _): &(&str, f64)| place.starts_with("array.") && *place != "array.place_mm";
        let array = self.session.numbers().filter(is_array);
        array.fold(self.finger.clone(), Finger::with)
    }

    /// Plays a scene into `heard`. Fails if its network cannot be restored.
    fn hear(
        &self,
        scene: &SceneFile,
        seed: u64,
        mut heard: Heard,
        hand: &mut dyn FnMut(&World, &[Down]) -> MotorDrive,
        mut judges: Vec<Judge>,
    ) -> anyhow::Result<Heard> {
        let mut world = World::seeded(scene, Seeds { making: self.finger.making, noise: seed });
        let mut ears = Ears::default();
        if self.taught.is_some() {
            ears.detectors.hebbian = self.network()?;
        }
        heard.said.resize(judges.len(), Vec::new());
        let (mut drive, mut slid) = (MotorDrive::Coast, 0);
        for sequence in 0.. {
            if world.now_s() >= heard.span_s.1 || world.truth().dropped {
                break;
            }
            let (frame, commands) = world.frame(sequence, drive);
            slid += u32::from(world.slipping());
            let t_s = world.now_s();
            let slides = 2 * slid > u32::from(FRAMES_PER_SLOW_FRAME);
            ears.take(&frame, drive, slides, &mut |felt| {
                for (judge, said) in judges.iter_mut().zip(&mut heard.said) {
                    Verdict::go_on(said, t_s, judge(felt));
                }
                if felt.features.is_some() {
                    slid = 0;
                }
            });
            drive = hand(&world, &commands);
            // An operator looks at the trace; of a minute without one it would only fill the memory.
            if heard.kind != Kind::Slips {
                drop(world.take_trace());
            }
        }
        heard.span_s.1 = world.now_s();
        heard.slips = fate::spans(world.truth());
        Ok(heard)
    }
}

/// Drives as the scene's commands on the line ask.
#[derive(Default)]
struct Line {
    drive: Option<MotorDrive>,
    left: u32,
}

impl Line {
    fn drive(&mut self, commands: &[Down]) -> MotorDrive {
        for command in commands {
            if let Down::Drive { drive, hold_ms } = command {
                (self.drive, self.left) = (Some(*drive), frames(u32::from(*hold_ms)));
            }
        }
        self.left = self.left.saturating_sub(1);
        self.drive.filter(|_| self.left > 0).unwrap_or(MotorDrive::Coast)
    }
}

/// The image's senses and detectors, without its reflex: it would change what the others hear.
#[derive(Default)]
struct Ears {
    config: Config,
    senses: Senses,
    samples: LastSamples,
    detectors: Detectors,
    journal: Journal,
    taxels: Reading,
    features: Preprocessor,
}

impl Ears {
    fn take(&mut self, frame: &Frame, drive: MotorDrive, slides: bool, hear: &mut dyn FnMut(&Felt<'_>)) {
        let Self { config, senses, samples, detectors, journal, taxels, features } = self;
        if frame.sequence == ZEROED_AT {
            // Refused while something is held, and then it follows by itself.
            let _is_zeroed = senses.zero();
        }
        journal.begin(frame);
        senses.process(config, frame, journal);
        samples.record(frame);
        let duty = match drive {
            MotorDrive::Close(duty) | MotorDrive::Open(duty) => duty.as_per_mille(),
            MotorDrive::Coast => 0,
        };
        let sensed = senses.sensed(config, frame, duty, false);
        if frame.slot() == WEIGHED {
            detectors.weigh(senses.sound(), false, false);
        }
        detectors.step(config, &sensed);
        let slot = usize::from(frame.slot());
        if let Some(taxel) = taxels.get_mut(slot) {
            *taxel = Some(frame.switch_b);
        }
        let new = if slot == ARRAY_COUNT { features.push(taxels) } else { None };
        let [slip, warns] = detectors.credible();
        let believed = detectors.slip().and(slip).or(detectors.incipient().and(warns));
        hear(&Felt { frame, sensed: &sensed, believed, features: new, slides });
        senses.driven(drive, false, GripMode::Watch, 1);
        if frame.ends_slow_frame() {
            senses.think(config, samples, journal);
            senses.listen(config, journal);
            let _told = journal.take_slow();
        }
        while journal.next_event().is_some() {}
    }
}
