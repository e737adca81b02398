//! As many lessons of each code as of its opposite.

use tenax_hal_shim::wire::NETWORK_OUTPUTS;
use tenax_hal_shim::words::{Code, Codes};

/// How many lessons of one code may be ahead of its opposite's: 2 s.
const AHEAD_MAX: i16 = 2_000;

/// Lessons of each code less those of its opposite.
///
/// Hebb's rule correlates: of what is felt all the time it learns whichever code it was taught longer, and every gauge
/// that feels the grasp becomes an offset (`docs/hebbian.md`). Nobody can be asked to lower as long as they lift, and the
/// reflex ends slips early, so a code that is too far ahead has to wait for its opposite.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Balance([i16; NETWORK_OUTPUTS]);

impl Balance {
    /// The codes that are not too far ahead, counted.
    pub(super) fn admit(&mut self, codes: Codes) -> [Option<Code>; NETWORK_OUTPUTS] {
        let mut admitted = [None; NETWORK_OUTPUTS];
        for ((ahead, slot), code) in self.0.iter_mut().zip(&mut admitted).zip(codes) {
            let after = *ahead + code.sign() as i16;
            if after.abs() <= AHEAD_MAX {
                *ahead = after;
                *slot = Some(code);
            }
        }
        admitted
    }
}
