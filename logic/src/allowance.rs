//! Token bucket for commands of the line: enough for any tool, too few to be late for or to crowd telemetry out.

use tenax_hal_shim::wire::Down;

/// Frames that earn one command: 500 commands a second. A camera sends 30, a held key 10.
const FRAMES_EACH: u32 = 4;
pub const BURST: u32 = 32;
/// Cost, in commands, of one whose answer fills a quarter of a slow frame's time on the line.
const LONG_ANSWER: u32 = 6;

#[derive(Clone, Copy, Debug)]
pub struct Allowance {
    left: u32,
    earned_at: u32,
}

impl Default for Allowance {
    fn default() -> Self {
        Self { left: BURST, earned_at: 0 }
    }
}

impl Allowance {
    pub fn admits(&mut self, frame: u32) -> bool {
        let earned = frame.wrapping_sub(self.earned_at) / FRAMES_EACH;
        self.earned_at = self.earned_at.wrapping_add(earned * FRAMES_EACH);
        self.left = self.left.saturating_add(earned).min(BURST);
        self.spend(1)
    }

    pub fn affords(&mut self, command: &Down) -> bool {
        !matches!(command, Down::Samples | Down::Network | Down::Settings(_) | Down::Last(_))
            || self.spend(LONG_ANSWER - 1)
    }

    const fn spend(&mut self, cost: u32) -> bool {
        let affordable = self.left >= cost;
        if affordable {
            self.left -= cost;
        }
        affordable
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_gets_what_is_earned_and_a_tool_all_it_asks() {
        let mut allowance = Allowance::default();
        let taken = (0..50_000u32).filter(|n| allowance.admits(n / 5)).count();
        assert!((2_500..=2_533).contains(&taken), "{taken} of 50,000 in 10,000 frames");
        let idle = 1_000_000;
        assert_eq!((0..100).filter(|_| allowance.admits(idle)).count(), BURST as usize);
        let mut allowance = Allowance::default();
        let all = (0..5).filter(|_| allowance.admits(0) && allowance.affords(&Down::Network)).count();
        assert_eq!(all, 5, "every long answer that there is");
        assert!((0..2).all(|_| allowance.admits(0) && allowance.affords(&Down::Ping)));
        assert!(!allowance.admits(3) && allowance.admits(4));
        // A long answer that is not earned yet is refused, and costs what its message does.
        assert!(allowance.admits(4 + 5 * FRAMES_EACH) && !allowance.affords(&Down::Network));
        assert!(allowance.admits(4 + 7 * FRAMES_EACH) && allowance.affords(&Down::Network));
    }
}
