//! The grip reflex: how much to close, once slip or incipient slip is known.
//!
//! Slip is answered by a short pulse at full speed, prolonged while a detector still says slip; incipient slip by a
//! shorter, slower one. After each, the object settles for longer than the motor's dead time before the detectors are asked
//! again. No pulse begins on a finger that is known to hold nothing or to press as hard as it may; without a known
//! force, the pulses share a small budget that only the wearer can renew.

pub mod settings;

use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::words::GripMode;

use self::settings::GripConfig;

/// What the reflex knows about force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grip {
    /// The force sensor gives no number.
    Unknown,
    /// The finger touches nothing, or hardly.
    Unloaded,
    /// It holds with this Fn, mN.
    Holds(i32),
}

/// The part of a load by which a pulse that is not in vain changes it: beyond the force sensor's noise.
const RAISES_PART: i32 = 200;

/// The reflex's memory.
#[derive(Clone, Copy, Debug)]
pub struct Reflex {
    elapsed: u32,
    /// Frames since the last pulse that answered incipient slip, saturating.
    since_incipient: u32,
    blind: u32,
    /// The load as the last pulse began, mN, and the pulses in a row that raised nothing.
    began_mn: Option<i32>,
    in_vain: u16,
}

impl Default for Reflex {
    fn default() -> Self {
        Self { elapsed: 0, since_incipient: u32::MAX, blind: 0, began_mn: None, in_vain: 0 }
    }
}

impl Reflex {
    /// Whether a pulse may begin or go on.
    #[must_use]
    pub const fn may_close(&self, config: &GripConfig, grip: Grip) -> bool {
        match grip {
            Grip::Unknown => self.blind < config.blind_frames,
            Grip::Unloaded => false,
            Grip::Holds(mn) => mn < config.ceiling_mn,
        }
    }

    /// Whether a drive command may close: an empty hand, or one that the reflex might close.
    #[must_use]
    pub const fn link_may_close(&self, config: &GripConfig, grip: Grip) -> bool {
        matches!(grip, Grip::Unloaded) || self.may_close(config, grip)
    }

    /// The mode has changed: what is timed begins now.
    pub fn enter(&mut self, config: &GripConfig, mode: GripMode, grip: Grip) {
        self.elapsed = 0;
        if crate::mode::closes(mode)
            && let Grip::Holds(mn) = grip
        {
            let raised = self.began_mn.is_none_or(|began| (mn - began).abs() > began / RAISES_PART);
            // A motor that reaches the ceiling at full duty stalls at no less than so much.
            let stalls_mn = config.ceiling_mn / 1_000 * i32::from(config.incipient_duty_permille);
            let raised = raised || mn < stalls_mn;
            self.in_vain = if raised { 0 } else { self.in_vain.saturating_add(1) };
            self.began_mn = Some(mn);
        }
        if mode == GripMode::Incipient {
            self.since_incipient = 0;
        }
    }

    /// A muscle is active: whoever sees the hand has taken over, and the budget of the blind begins anew.
    pub const fn renew(&mut self) {
        (self.blind, self.began_mn, self.in_vain) = (0, None, 0);
    }

    /// A drive command closes in this frame: without a known force it spends the same budget.
    pub fn spend(&mut self, grip: Grip) {
        if grip == Grip::Unknown {
            self.blind = self.blind.saturating_add(1);
        }
    }

    /// How long the mode has lasted, in frames.
    #[must_use]
    pub const fn elapsed(&self) -> u32 {
        self.elapsed
    }

    /// Goes on by one frame.
    pub fn tick(&mut self, mode: GripMode, grip: Grip) {
        self.elapsed = self.elapsed.saturating_add(1);
        self.since_incipient = self.since_incipient.saturating_add(1);
        if crate::mode::closes(mode) {
            self.spend(grip);
        }
    }

    /// Whether the pulse of this mode is over. `slips`: a detector still says slip.
    #[must_use]
    pub const fn pulse_over(&self, config: &GripConfig, mode: GripMode, slips: bool, grip: Grip) -> bool {
        let length = match mode {
            GripMode::Slip if slips => config.slip_frames_max,
            GripMode::Slip => config.slip_frames,
            GripMode::Incipient => config.incipient_frames,
            _ => 0,
        };
        self.elapsed >= length || !self.may_close(config, grip)
    }

    /// Whether incipient slip may be answered again: the last answer has had its time to show in Ft/Fn. Slip itself is
    /// answered meanwhile.
    #[must_use]
    pub const fn may_tighten(&self, config: &GripConfig) -> bool {
        self.since_incipient >= config.incipient_frames + config.settle_frames
    }

    /// Whether the object has had its time to settle.
    #[must_use]
    pub const fn settled(&self, config: &GripConfig) -> bool {
        self.elapsed >= config.settle_frames
    }

    /// How the reflex drives the motor in this mode. A small pulse that raised nothing has stalled: the next is stronger by as much.
    #[must_use]
    pub fn drive(&self, config: &GripConfig, mode: GripMode) -> MotorDrive {
        match mode {
            GripMode::Slip => MotorDrive::Close(Duty::per_mille(config.slip_duty_permille)),
            GripMode::Incipient => {
                let stronger = config.incipient_duty_permille.saturating_mul(self.in_vain.saturating_add(1));
                // Never stronger than what answers slip, unless it is set so.
                let most = config.slip_duty_permille.max(config.incipient_duty_permille);
                MotorDrive::Close(Duty::per_mille(stronger.min(most)))
            }
            _ => MotorDrive::Coast,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;

    fn pulse_frames(mode: GripMode, slips: bool, grip: Grip) -> u32 {
        let config = Config::default().grip;
        let mut reflex = Reflex::default();
        reflex.enter(&config, mode, grip);
        (0..10_000)
            .take_while(|_| {
                let over = reflex.pulse_over(&config, mode, slips, grip);
                reflex.tick(mode, grip);
                !over
            })
            .count() as u32
    }

    #[test]
    fn pulses_have_their_lengths_and_end_at_the_ceiling() {
        let config = Config::default().grip;
        assert_eq!(pulse_frames(GripMode::Slip, false, Grip::Holds(5_000)), config.slip_frames);
        assert_eq!(pulse_frames(GripMode::Slip, true, Grip::Holds(5_000)), config.slip_frames_max);
        assert_eq!(pulse_frames(GripMode::Incipient, true, Grip::Holds(5_000)), config.incipient_frames);
        assert_eq!(pulse_frames(GripMode::Slip, true, Grip::Holds(config.ceiling_mn)), 0);
        assert_eq!(pulse_frames(GripMode::Slip, true, Grip::Unloaded), 0);
    }

    #[test]
    fn without_a_force_the_budget_runs_out_and_the_wearer_renews_it() {
        let config = Config::default().grip;
        let mut reflex = Reflex::default();
        for _ in 0..config.blind_frames {
            assert!(reflex.may_close(&config, Grip::Unknown));
            reflex.tick(GripMode::Slip, Grip::Unknown);
        }
        assert!(!reflex.may_close(&config, Grip::Unknown));
        reflex.enter(&config, GripMode::Slip, Grip::Unknown);
        assert!(!reflex.may_close(&config, Grip::Unknown) && !reflex.link_may_close(&config, Grip::Unknown));
        reflex.renew();
        assert!(reflex.may_close(&config, Grip::Unknown));
    }

    #[test]
    fn the_line_is_bound_by_the_ceiling_and_shares_the_budget() {
        let config = Config::default().grip;
        let mut reflex = Reflex::default();
        assert!(reflex.link_may_close(&config, Grip::Unloaded), "an empty hand may take something");
        assert!(!reflex.link_may_close(&config, Grip::Holds(config.ceiling_mn)));
        for _ in 0..config.blind_frames {
            assert!(reflex.link_may_close(&config, Grip::Unknown));
            reflex.spend(Grip::Unknown);
        }
        assert!(!reflex.link_may_close(&config, Grip::Unknown) && !reflex.may_close(&config, Grip::Unknown));
    }
}
