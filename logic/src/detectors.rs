//! The detectors: one trait, one static list, one record of what they report and which reports are believed.
//!
//! `docs/adding-a-detector.md` says what one more takes.

mod injected;

use heapless::Vec;
use tenax_hal_shim::channel::PVDF_COUNT;
use tenax_hal_shim::detector::{DetectorHealth, DetectorId, DetectorSet, Direction, Evidence};
use tenax_hal_shim::schedule::{Job, slot_of};
use tenax_hal_shim::wire::{DETECTORS_MAX, Forces};

use crate::array::{MLP_DECIDES, MlpDetector, Reading};
use crate::config::Config;
use crate::force::FrictionDetector;
use crate::hebbian::HebbianDetector;
use crate::photoelastic::{Head, PhotoelasticDetector};
use crate::plausibility::{Disturbance, Plausibility};
use crate::strain::Gauges;
use crate::vibration::Vibration;
use crate::vibration::detector::S1;

pub use injected::Injected;

/// Conditioned signals of one frame: the input of every detector.
#[derive(Clone, Copy, Debug)]
pub struct Sensed<'a> {
    /// Sequence number of the frame.
    pub frame: u32,
    /// Slot of the frame in the slow frame, 0 to 24.
    pub slot: u8,
    /// Whether the frame is valid. If not, it has no samples and only time has passed.
    pub valid: bool,
    /// The vibration of all PVDF channels.
    pub vibration: Vibration,
    /// Each PVDF channel's envelope in the slip band, 14-bit samples in Q16: 65536 is one sample.
    pub envelopes: &'a [i32; PVDF_COUNT],
    /// Whether any PVDF channel gives numbers.
    pub vibration_known: bool,
    /// The strain gauges.
    pub strain: &'a Gauges,
    /// Forces, None while the force sensor gives no number.
    pub forces: Option<&'a Forces>,
    /// Whether this frame brought new forces.
    pub forces_are_new: bool,
    /// The normal-force array's last readings.
    pub taxels: &'a Reading,
    /// The photoelastic head; without readings while a film is in its place.
    pub head: &'a Head,
    /// The finger is known to touch nothing.
    pub unloaded: bool,
    /// The finger holds something.
    pub grasp: bool,
    /// The motor runs fast, or an impact rings: vibration does not come from the object.
    pub noisy: bool,
    /// The reflex or the wearer moves the hand.
    pub moves: bool,
    /// A muscle is active, its hold time included.
    pub wearer: bool,
}

/// A detector's report: the object slips, or is about to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Said {
    /// The object slips.
    pub slip: bool,
    /// The object is about to slip: a warning.
    pub incipient: bool,
}

impl Said {
    /// Neither slip nor a warning.
    pub const NOTHING: Self = Self { slip: false, incipient: false };

    /// Slip or not, without a warning.
    pub const fn slip(slip: bool) -> Self {
        Self { slip, incipient: false }
    }
}

/// The rest of a detector's evidence, computed once a slow frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Description {
    /// Confidence that the object slips, 0 to 1000 per mille.
    pub confidence_permille: u16,
    /// The direction of slip.
    pub direction: Direction,
    /// Whether the detector has the input that it needs.
    pub health: DetectorHealth,
    /// The number that it compares with its threshold, on its own scale: see [`Evidence::raw`].
    pub raw: i32,
}

/// A detector. It owns its state; its configuration is passed in.
///
/// ```
/// use tenax_hal_shim::detector::DetectorId;
/// use tenax_logic::detectors::{Description, Detector, Said, Sensed};
///
/// /// Says slip while an impact rings.
/// struct Toy;
///
/// impl Detector for Toy {
///     // One that joins the list has a number of its own.
///     const ID: DetectorId = DetectorId::Injected;
///     type Config = ();
///
///     fn step(&mut self, _config: &(), sensed: &Sensed<'_>) -> Option<Said> {
///         Some(Said::slip(sensed.vibration.impact))
///     }
///
///     fn describe(&self, _config: &()) -> Description {
///         Description::default()
///     }
/// }
/// ```
pub trait Detector {
    /// The detector's identifier.
    const ID: DetectorId;
    /// Largest number of consecutive slow frames in which it may report slip of an empty hand without being ignored.
    const IMPLAUSIBLE_AFTER: u16 = 0;
    /// Settings of the detector.
    type Config;

    /// Takes one frame. None: no new conclusion, and the last report stands.
    fn step(&mut self, config: &Self::Config, sensed: &Sensed<'_>) -> Option<Said>;

    /// The rest of its evidence: confidence, direction, health, raw number.
    fn describe(&self, config: &Self::Config) -> Description;
}

/// The slot in which plausibility of all detectors but the MLP is judged.
const OTHERS_GUARDED: u8 = slot_of(Job::Think) + 1;

/// Runs a piece of code with each detector and its configuration: the static list of them.
macro_rules! for_each_detector {
    ($self:ident, $config:expr, |$detector:ident, $own:ident| $body:expr) => {{
        {
            let ($detector, $own) = (&mut $self.s1, &$config.vibration);
            $body;
        }
        {
            let ($detector, $own) = (&mut $self.s2, &$config.friction);
            $body;
        }
        {
            let ($detector, $own) = (&mut $self.hebbian, &$config.hebbian);
            $body;
        }
        {
            let ($detector, $own) = (&mut $self.mlp, &());
            $body;
        }
        {
            let ($detector, $own) = (&mut $self.injected, &());
            $body;
        }
        {
            let ($detector, $own) = (&mut $self.photoelastic, &$config.head);
            $body;
        }
    }};
}

/// All detectors and their reports.
#[derive(Clone, Debug, Default)]
pub struct Detectors {
    s1: S1,
    /// S2; strokes measure its threshold.
    pub s2: FrictionDetector,
    /// The Hebbian network, which a teacher teaches.
    pub hebbian: HebbianDetector,
    mlp: MlpDetector,
    /// Reports from outside.
    pub injected: Injected,
    photoelastic: PhotoelasticDetector,
    record: Record,
}

/// Last report of each detector, its frame, and whether the guard ignores it.
#[derive(Clone, Debug, Default)]
struct Record {
    slip: DetectorSet,
    incipient: DetectorSet,
    ignored: DetectorSet,
    decided_at: [u32; DetectorId::COUNT],
    guards: [Plausibility; DetectorId::COUNT],
    /// Guard of the array's report while the hand moves or an impact rings.
    disturbance: Disturbance,
}

impl Record {
    #[inline(always)]
    fn note(&mut self, id: DetectorId, said: Said, frame: u32) {
        self.slip = self.slip.with(id, said.slip);
        self.incipient = self.incipient.with(id, said.incipient);
        self.decided_at[id as usize] = frame;
    }

    fn guard(&mut self, id: DetectorId, tolerated: u16, sensed: &Sensed<'_>) {
        let says = self.slip.or(self.incipient).contains(id);
        let guard = &mut self.guards[id as usize];
        guard.step(sensed.unloaded, says, tolerated);
        self.ignored = self.ignored.with(id, guard.is_ignored());
    }

    #[inline(always)]
    fn guard_array(&mut self, sensed: &Sensed<'_>) {
        let id = DetectorId::Mlp;
        self.guard(id, MlpDetector::IMPLAUSIBLE_AFTER, sensed);
        self.disturbance.step(sensed.vibration.impact, self.slip.contains(id));
        self.ignored = self.ignored.with(id, self.ignored.contains(id) || self.disturbance.explains_it());
    }
}

/// Whether at least two of these report slip: films, array, head, injected reports.
fn by_two_senses(slip: DetectorSet) -> bool {
    let films = slip.contains(DetectorId::S1) || slip.contains(DetectorId::Hebbian);
    let others = [DetectorId::Mlp, DetectorId::Photoelastic, DetectorId::Injected];
    u8::from(films) + others.into_iter().map(|id| u8::from(slip.contains(id))).sum::<u8>() >= 2
}

/// The detector's number, from a reference to it.
const fn id_of<D: Detector>(_: &D) -> DetectorId {
    D::ID
}

const fn tolerance_of<D: Detector>(_: &D) -> u16 {
    D::IMPLAUSIBLE_AFTER
}

impl Detectors {
    /// Takes one frame.
    pub fn step(&mut self, config: &Config, sensed: &Sensed<'_>) {
        for_each_detector!(self, config, |detector, own| {
            if let Some(said) = detector.step(own, sensed) {
                self.record.note(id_of(detector), said, sensed.frame);
            }
        });
        // The MLP decides once a cycle, and an implausible verdict is not believed for a single tick. The others are guarded in a
        // slot with room.
        match sensed.slot {
            MLP_DECIDES => self.record.guard_array(sensed),
            OTHERS_GUARDED => self.guard_others(config, sensed),
            _ => {}
        }
    }

    #[inline(never)]
    fn guard_others(&mut self, config: &Config, sensed: &Sensed<'_>) {
        for_each_detector!(self, config, |detector, _own| {
            let (id, tolerated) = (id_of(detector), tolerance_of(detector));
            if id != DetectorId::Mlp {
                self.record.guard(id, tolerated, sensed);
            }
        });
    }

    /// The reflex tightens because S2 warns: the array's next reports may come from that.
    #[inline(never)]
    pub const fn tightened(&mut self) {
        self.record.disturbance.begin();
    }

    /// The detectors that say slip.
    pub const fn slip(&self) -> DetectorSet {
        self.record.slip
    }

    /// The detectors that warn of slip.
    pub const fn incipient(&self) -> DetectorSet {
        self.record.incipient
    }

    /// The detectors whose reports are believed: all but those that report slip of an empty hand; none where slip is unlikely and only
    /// one kind of sensor reports it.
    pub fn credible(&self) -> DetectorSet {
        let Record { slip, ignored, .. } = self.record;
        if self.s2.is_slip_unlikely() && !by_two_senses(slip.without(ignored)) {
            DetectorSet::NONE
        } else {
            DetectorSet::ALL.without(ignored)
        }
    }

    /// Each detector's last conclusion.
    #[must_use]
    #[inline(never)]
    pub fn evidence(&mut self, config: &Config) -> Vec<(DetectorId, Evidence), DETECTORS_MAX> {
        let mut all = Vec::new();
        for_each_detector!(self, config, |detector, own| {
            let id = id_of(detector);
            // A head that is not there has no evidence.
            if id != DetectorId::Photoelastic || config.head.fitted {
                let Description { confidence_permille, direction, health, raw } = detector.describe(own);
                let evidence = Evidence {
                    slip: self.record.slip.contains(id),
                    incipient: self.record.incipient.contains(id),
                    confidence_permille,
                    direction,
                    decided_at: self.record.decided_at[id as usize],
                    health,
                    raw,
                };
                // There is room for every detector.
                let _fits = all.push((id, evidence));
            }
        });
        all
    }
}

const _: () = assert!(DetectorId::COUNT <= DETECTORS_MAX);

/// How sure a threshold is: 500 per mille at it, 0 at nothing, 1000 at twice it.
pub(crate) fn confidence(value: i32, threshold: i32) -> u16 {
    // Nothing is above 2^22, and 32 bits are divided by one instruction.
    let value = value.clamp(0, 1 << 22).unsigned_abs();
    let permille = value * 500 / threshold.max(1).unsigned_abs();
    permille.min(1_000) as u16
}
