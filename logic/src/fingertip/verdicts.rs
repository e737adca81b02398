//! From the detectors' reports to those that are believed and acted on.

use tenax_hal_shim::detector::{DetectorId, DetectorSet};

use crate::detectors::Detectors;
use crate::grip::slide::Heard;

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Verdicts {
    pub said: DetectorSet,
    pub believed: DetectorSet,
    pub slip: DetectorSet,
    pub incipient: DetectorSet,
}

impl Verdicts {
    /// `off`: detectors that the reflex does not act on.
    pub fn of(detectors: &Detectors, off: DetectorSet) -> Self {
        let (slip, incipient) = (detectors.slip(), detectors.incipient());
        let said = slip.or(incipient);
        if said.is_empty() {
            return Self::default();
        }
        let [credible, warns] = detectors.credible();
        let (slip, incipient) = (slip.and(credible), incipient.and(warns));
        Self {
            said,
            believed: slip.or(incipient),
            slip: slip.without(off),
            incipient: incipient.without(off),
        }
    }

    /// `loud`: S1 is above its own threshold.
    pub fn heard(&self, loud: bool) -> Heard {
        if self.slip.is_empty() {
            return Heard::default();
        }
        let hears = self.slip.contains(DetectorId::S1);
        let felt = !self.slip.without(DetectorSet::only(DetectorId::S1)).is_empty();
        Heard { loud: hears && loud, quiet: hears && !loud, felt }
    }
}
