//! From the detectors' reports to those that are believed and acted on.

use tenax_hal_shim::detector::{DetectorId, DetectorSet};

use crate::detectors::Detectors;

/// The detectors that the reflex may act on: by default all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Acting(pub DetectorSet);

impl Default for Acting {
    fn default() -> Self {
        Self(DetectorSet::ALL)
    }
}

impl Acting {
    /// This set without the detectors `off`.
    pub const fn but(self, off: DetectorSet) -> Self {
        Self(self.0.without(off))
    }
}

/// The detectors' reports in one tick: all, and those that are believed and may be acted on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Verdicts {
    /// Detectors that report slip or a warning.
    pub said: DetectorSet,
    /// Those of them that are believed.
    pub believed: DetectorSet,
    /// Detectors whose report of slip is believed and may be acted on.
    pub slip: DetectorSet,
    /// Detectors whose warning is believed and may be acted on.
    pub incipient: DetectorSet,
}

impl Verdicts {
    /// `unlikely`: by the forces nothing slips. A single sense is then not believed.
    pub fn of(detectors: &Detectors, Acting(acting): Acting, unlikely: bool) -> Self {
        let (slip, incipient) = (detectors.slip(), detectors.incipient());
        let heard = |said: DetectorSet| said.without(detectors.ignored());
        let said = slip.or(incipient);
        let believed = if unlikely && !by_two_senses(heard(slip)) { DetectorSet::NONE } else { heard(said) };
        let acted = believed.and(acting);
        Self { said, believed, slip: slip.and(acted), incipient: incipient.and(acted) }
    }
}

/// Whether at least two of these report slip: films, array, head, injected reports.
fn by_two_senses(slip: DetectorSet) -> bool {
    let films = slip.contains(DetectorId::S1) || slip.contains(DetectorId::Hebbian);
    let others = [DetectorId::Mlp, DetectorId::Photoelastic, DetectorId::Injected];
    u8::from(films) + others.into_iter().map(|id| u8::from(slip.contains(id))).sum::<u8>() >= 2
}
