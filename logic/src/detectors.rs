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
use crate::evidence::{Clues, LogOdds, Sound};
use crate::force::FrictionDetector;
use crate::hebbian::HebbianDetector;
use crate::photoelastic::{Head, PhotoelasticDetector};
use crate::plausibility::Plausibility;
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

const OTHERS_GUARDED: u8 = slot_of(Job::Think) + 1;
/// After the films' and the array's.
pub const WEIGHED: u8 = slot_of(Job::Save) + 2;

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
    weighed: LogOdds,
    /// Nothing but the films' quiet sound is slip.
    quiet: bool,
}

#[derive(Clone, Debug, Default)]
struct Record {
    slip: DetectorSet,
    incipient: DetectorSet,
    ignored: DetectorSet,
    /// S1 is above its own threshold.
    s1_alone: bool,
    decided_at: [u32; DetectorId::COUNT],
    guards: [Plausibility; DetectorId::COUNT],
}

impl Record {
    #[inline(always)]
    fn note(&mut self, id: DetectorId, said: Said, frame: u32) {
        self.slip = self.slip.with(id, said.slip);
        self.incipient = self.incipient.with(id, said.incipient);
        self.decided_at[id as usize] = frame;
    }

    /// Senses that report slip each by itself: S1 and the network hear the same films.
    fn reports(&self) -> i32 {
        let slip = self.slip.without(self.ignored);
        let films = self.s1_alone || slip.contains(DetectorId::Hebbian);
        let others =
            [DetectorId::Photoelastic, DetectorId::Injected].into_iter().filter(|&id| slip.contains(id));
        i32::from(films) + others.count() as i32
    }

    fn guard(&mut self, id: DetectorId, sensed: &Sensed<'_>) {
        let says = self.slip.or(self.incipient).contains(id);
        let guard = &mut self.guards[id as usize];
        guard.step(sensed.unloaded, says);
        self.ignored = self.ignored.with(id, guard.is_ignored());
    }
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
        // The MLP decides once a cycle, and an implausible verdict must not act for a single tick.
        match sensed.slot {
            MLP_DECIDES => self.record.guard(DetectorId::Mlp, sensed),
            OTHERS_GUARDED => self.guard_others(config, sensed),
            _ => {}
        }
        self.record.s1_alone = sensed.vibration.s1;
        self.record.slip =
            self.record.slip.with(DetectorId::S1, self.record.slip.contains(DetectorId::S1) | self.quiet);
    }

    /// Call it once a slow frame, in slot [`WEIGHED`]. `sound`: none if the hand itself may be what the films hear. `moves`: the
    /// motor has been loud within 100 ms. `answers`: the reflex moves the hand or lets it settle.
    #[inline(never)]
    pub fn weigh(&mut self, sound: Option<Sound>, moves: bool, answers: bool) {
        let (array, ratio_permille) = (self.mlp.millinats(), self.s2.ratio_permille());
        self.weighed.weigh(&Clues { sound, array, ratio_permille, moves, answers });
        self.quiet = self.weighed.hears_slip() && !self.record.slip.contains(DetectorId::Mlp);
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

    pub const fn slip(&self) -> DetectorSet {
        self.record.slip
    }

    pub const fn incipient(&self) -> DetectorSet {
        self.record.incipient
    }

    /// Detectors whose slip is believed, and those whose warning is: steady sliding is worth a report.
    #[inline(never)]
    pub fn credible(&self) -> [DetectorSet; 2] {
        let (heeded, reports) = (DetectorSet::ALL.without(self.record.ignored), self.record.reports());
        let slides = self.weighed.slips(reports.max(1));
        let slip = if self.weighed.slips(reports) { heeded } else { DetectorSet::NONE };
        [slip, heeded.with(DetectorId::S1, slides)]
    }

    pub fn sure_permille(&self) -> i32 {
        self.weighed.sure_permille(self.record.reports())
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
