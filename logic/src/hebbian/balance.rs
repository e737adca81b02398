//! Balances the lessons: each code is taught as often as its opposite.

use tenax_hal_shim::wire::NETWORK_OUTPUTS;
use tenax_hal_shim::words::{Code, Codes};

const AHEAD_MAX: i16 = 2_000;

/// Lessons of each code less those of its opposite: Hebb's rule lets a constant input learn whichever code was
/// taught longer.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Balance([i16; NETWORK_OUTPUTS]);

impl Balance {
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
