//! The detectors: one trait, one static list, their last reports and which of them are believed.
//! `docs/extending.md` shows how to add one.

mod injected;

use heapless::Vec;
use tenax_hal_shim::channel::PVDF_COUNT;
use tenax_hal_shim::detector::{DetectorHealth, DetectorId, DetectorSet, Direction, Evidence};
use tenax_hal_shim::schedule::{Job, slot_of};
use tenax_hal_shim::wire::{DETECTORS_MAX, Forces};

use crate::array::{MLP_DECIDES, Reading, ShippedDetector};
use crate::config::Config;
use crate::force::FrictionDetector;
use crate::hebbian::HebbianDetector;
use crate::photoelastic::{Head, PhotoelasticDetector};
use crate::plausibility::{Disturbance, Plausibility};
use crate::strain::Gauges;
use crate::vibration::Vibration;
use crate::vibration::detector::S1;

pub use injected::Injected;

#[derive(Clone, Copy, Debug)]
pub struct Sensed<'a> {
    pub frame: u32,
    pub slot: u8,
    pub valid: bool,
    pub vibration: Vibration,
    /// Envelopes in the slip band, Q16 samples (14 bits).
    pub envelopes: &'a [i32; PVDF_COUNT],
    pub vibration_known: bool,
    pub strain: &'a Gauges,
    pub forces: Option<&'a Forces>,
    pub forces_are_new: bool,
    pub taxels: &'a Reading,
    pub head: &'a Head,
    pub unloaded: bool,
    pub grasp: bool,
    pub noisy: bool,
    pub moves: bool,
    pub wearer: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Said {
    pub slip: bool,
    pub incipient: bool,
}

impl Said {
    pub const NOTHING: Self = Self { slip: false, incipient: false };

    pub const fn slip(slip: bool) -> Self {
        Self { slip, incipient: false }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Description {
    pub confidence_permille: u16,
    pub direction: Direction,
    pub health: DetectorHealth,
    pub raw: i32,
}

pub trait Detector {
    const ID: DetectorId;
    type Config;

    /// None: the last report stands.
    fn step(&mut self, config: &Self::Config, sensed: &Sensed<'_>) -> Option<Said>;

    fn describe(&self, config: &Self::Config) -> Description;
}

/// Readings before the array's verdict in which the films must have been loud, or half so, for it to be believed alone:
/// it looks back on as much, 200 ms.
const HEARD_WITHIN: u8 = 16;
const OTHERS_GUARDED: u8 = slot_of(Job::Think) + 1;

macro_rules! for_each_detector {
    ($self:ident, $config:expr, |$detector:ident, $own:ident| $body:expr) => {{
        for_each_detector!(@ $detector, $own, $body;
            $self.s1, $config.vibration;
            $self.s2, $config.friction;
            $self.hebbian, $config.hebbian;
            $self.mlp, ();
            $self.injected, ();
            $self.photoelastic, $config.head)
    }};
    (@ $detector:ident, $own:ident, $body:expr; $($each:expr, $settings:expr);+) => {
        {$({
            let ($detector, $own) = (&mut $each, &$settings);
            $body;
        })+}
    };
}

#[derive(Clone, Debug, Default)]
pub struct Detectors {
    s1: S1,
    pub s2: FrictionDetector,
    pub hebbian: HebbianDetector,
    mlp: ShippedDetector,
    pub injected: Injected,
    photoelastic: PhotoelasticDetector,
    record: Record,
    /// An object has slid in this grasp.
    pub has_slid: bool,
}

#[derive(Clone, Debug, Default)]
struct Record {
    slip: DetectorSet,
    incipient: DetectorSet,
    ignored: DetectorSet,
    decided_at: [u32; DetectorId::COUNT],
    guards: [Plausibility; DetectorId::COUNT],
    disturbance: Disturbance,
    /// The films give no reading.
    is_deaf: bool,
    /// Readings since the films were loud as slip, or half so.
    silent_for: u8,
}

impl Record {
    #[inline(always)]
    fn note(&mut self, id: DetectorId, said: Said, frame: u32) {
        self.slip = self.slip.with(id, said.slip);
        self.incipient = self.incipient.with(id, said.incipient);
        self.decided_at[id as usize] = frame;
    }

    fn guard(&mut self, id: DetectorId, sensed: &Sensed<'_>) {
        let says = self.slip.or(self.incipient).contains(id);
        let guard = &mut self.guards[id as usize];
        guard.step(sensed.unloaded, says);
        self.ignored = self.ignored.with(id, guard.is_ignored());
    }

    #[inline(always)]
    fn guard_array(&mut self, sensed: &Sensed<'_>) {
        let id = DetectorId::Mlp;
        self.guard(id, sensed);
        self.disturbance.step(sensed.vibration.impact, self.slip.contains(id));
        self.ignored = self.ignored.with(id, self.ignored.contains(id) || self.disturbance.explains_it());
    }
}

fn by_two_senses(slip: DetectorSet) -> bool {
    let films = slip.contains(DetectorId::S1) || slip.contains(DetectorId::Hebbian);
    let others = [DetectorId::Mlp, DetectorId::Photoelastic, DetectorId::Injected];
    u8::from(films) + others.into_iter().map(|id| u8::from(slip.contains(id))).sum::<u8>() >= 2
}

const fn id_of<D: Detector>(_: &D) -> DetectorId {
    D::ID
}

impl Detectors {
    pub fn step(&mut self, config: &Config, sensed: &Sensed<'_>) {
        for_each_detector!(self, config, |detector, own| {
            if let Some(said) = detector.step(own, sensed) {
                self.record.note(id_of(detector), said, sensed.frame);
            }
        });
        self.record.silent_for = sensed.vibration.silent_for;
        self.record.is_deaf = !sensed.vibration_known;
        // The MLP decides once a cycle, and an implausible verdict must not act for a single tick.
        match sensed.slot {
            MLP_DECIDES => self.record.guard_array(sensed),
            OTHERS_GUARDED => self.guard_others(config, sensed),
            _ => {}
        }
    }

    #[inline(never)]
    fn guard_others(&mut self, config: &Config, sensed: &Sensed<'_>) {
        for_each_detector!(self, config, |detector, _own| {
            let id = id_of(detector);
            // S1's threshold knows what the empty hand hears, and injected reports are never implausible.
            if !matches!(id, DetectorId::S1 | DetectorId::Injected | DetectorId::Mlp) {
                self.record.guard(id, sensed);
            }
        });
    }

    /// S2's warning is being answered: the array's next reports may come from the closing.
    #[inline(never)]
    pub const fn tightened(&mut self) {
        self.record.disturbance.begin();
    }

    pub const fn slip(&self) -> DetectorSet {
        self.record.slip
    }

    pub const fn incipient(&self) -> DetectorSet {
        self.record.incipient
    }

    pub fn credible(&self) -> DetectorSet {
        let Record { slip, incipient, ignored, .. } = self.record;
        if self.s2.is_slip_unlikely(self.has_slid) && !by_two_senses(slip.without(ignored)) {
            return DetectorSet::NONE;
        }
        let array = DetectorSet::NONE.with(DetectorId::Mlp, true);
        let alone = slip.or(incipient).without(ignored) == array && !self.record.is_deaf;
        let far = alone && self.record.silent_for >= HEARD_WITHIN;
        let ignored = if far { ignored.or(array) } else { ignored };
        DetectorSet::ALL.without(ignored)
    }

    #[must_use]
    #[inline(never)]
    pub fn evidence(&mut self, config: &Config) -> Vec<(DetectorId, Evidence), DETECTORS_MAX> {
        let mut all = Vec::new();
        for_each_detector!(self, config, |detector, own| {
            let id = id_of(detector);
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
                let _fits = all.push((id, evidence));
            }
        });
        all
    }
}

const _: () = assert!(DetectorId::COUNT <= DETECTORS_MAX);

/// 500 per mille at the threshold, 0 at nothing, 1000 at twice it.
pub(crate) fn confidence(value: i32, threshold: i32) -> u16 {
    // Clamped, so that one 32-bit division is enough.
    let value = value.clamp(0, 1 << 22).unsigned_abs();
    let permille = value * 500 / threshold.max(1).unsigned_abs();
    permille.min(1_000) as u16
}
