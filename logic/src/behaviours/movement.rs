//! A small movement of the fingers and the wait after it, of which behaviours consist (FingerVision 2017, section II).

use tenax_hal_shim::motor::Duty;

use super::{BehaviourConfig, Wish};

#[derive(Clone, Copy, Debug, Default)]
pub struct Movement {
    wish: Wish,
    drives_left: u32,
    waits_left: u32,
}

impl Movement {
    pub const fn tighten(config: &BehaviourConfig) -> Self {
        Self::lasting(config, Wish::Tighten(Duty::per_mille(config.duty_permille)), config.movement_frames)
    }

    pub const fn relax(config: &BehaviourConfig) -> Self {
        Self::lasting(config, Wish::Relax(Duty::per_mille(config.duty_permille)), config.movement_frames)
    }

    pub const fn lasting(config: &BehaviourConfig, wish: Wish, frames: u32) -> Self {
        Self { wish, drives_left: frames, waits_left: config.wait_frames }
    }

    pub const fn is_over(&self) -> bool {
        self.drives_left == 0 && self.waits_left == 0
    }

    pub const fn drives(&self) -> bool {
        self.drives_left > 0
    }

    pub const fn step(&mut self) -> Wish {
        if self.drives_left > 0 {
            self.drives_left -= 1;
            return self.wish;
        }
        self.waits_left = self.waits_left.saturating_sub(1);
        Wish::Rest
    }
}
