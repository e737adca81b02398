//! A causal oracle: it knows slip, friction and load as they were 20 ms ago and never the future, has no detector, and closes the same
//! gripper under the same wearer.

use std::collections::VecDeque;

use tenax_hal_shim::channel::FRAME_HZ;

/// How late it knows, frames: the fastest published reaction to a slip takes 20.4 ms, sd 6 (arXiv 2602.16127).
const LATE_FRAMES: usize = (FRAME_HZ / 50) as usize;
/// Force over what the load needs at this friction (Westling and Johansson 1984: people keep 1.1 to 1.5).
const MARGIN: f64 = 1.2;

/// What the oracle knows of one frame, N a finger.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    pub(crate) needed_n: f64,
    /// What carries and stops it while it slides.
    pub(crate) stops_n: Option<f64>,
    /// A muscle is active: the wearer comes first, and the oracle commands nothing.
    pub(crate) wearer_active: bool,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Causal {
    under_way: VecDeque<f64>,
    target_n: f64,
}

impl Causal {
    /// Takes in a frame.
    pub(crate) fn see(&mut self, known: Known) {
        let target_n = MARGIN * known.needed_n.max(known.stops_n.unwrap_or(0.0));
        self.under_way.push_back(target_n);
        let late_n = if self.under_way.len() > LATE_FRAMES { self.under_way.pop_front() } else { None };
        self.target_n = late_n.filter(|_| !known.wearer_active).unwrap_or(0.0);
    }

    /// Force that each finger should press with now, N. 0 asks for nothing.
    pub(crate) const fn target_n(&self) -> f64 {
        self.target_n
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_asks_for_the_margin_20_ms_late_and_for_nothing_while_a_muscle_is_active() {
        let mut causal = Causal::default();
        let mut target_n = |needed_n, stops_n, wearer_active| {
            causal.see(Known { needed_n, stops_n, wearer_active });
            causal.target_n()
        };
        assert!((0..40).all(|_| target_n(5.0, Some(7.0), false) == 0.0));
        assert_eq!([target_n(1.0, None, true), target_n(1.0, None, false)], [0.0, 1.2 * 7.0]);
    }
}
