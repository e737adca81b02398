//! From the detectors' reports to those that are believed and acted on.

use tenax_hal_shim::detector::DetectorSet;

use crate::detectors::Detectors;

#[derive(Clone, Copy, Debug)]
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
        let believed = said.and(detectors.credible());
        let acted = believed.without(off);
        Self { said, believed, slip: slip.and(acted), incipient: incipient.and(acted) }
    }
}
