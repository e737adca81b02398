//! The myoelectric gate: what the wearer asks for, and whether they ask for anything (Prosthesis, section 5: "the sensor
//! system should be activated only in case the myosensors are not active").
//!
//! What the two envelopes mean is decided in [`emg`](crate::emg). Here it becomes a motor drive, and activity is held for
//! a while, so that the reflex does not speak between two contractions.

use tenax_hal_shim::motor::{Duty, MotorDrive};

use crate::emg::Verdict;
use crate::emg::intent::Wish;
use crate::emg::settings::GateConfig;

/// Both muscles.
#[derive(Clone, Copy, Debug, Default)]
pub struct Gate {
    verdict: Verdict,
    mv: [Option<i16>; 2],
    hold: u32,
    known_frames: u32,
}

impl Gate {
    /// Takes what the muscles say from now on.
    pub const fn take(&mut self, verdict: Verdict) {
        self.verdict = verdict;
    }

    /// Takes a muscle's envelope above rest, mV, none where the sensor gives no number: 0 the flexor's, others the
    /// extensor's. It is only told, not decided on.
    pub const fn show(&mut self, muscle: usize, mv: Option<i16>) {
        self.mv[if muscle == 0 { 0 } else { 1 }] = mv;
    }

    /// Goes on by one frame.
    pub const fn tick(&mut self, config: &GateConfig) {
        if self.verdict.active {
            self.hold = config.hold_frames;
        } else {
            self.hold = self.hold.saturating_sub(1);
        }
        self.known_frames = if self.is_known() { self.known_frames.saturating_add(1) } else { 0 };
    }

    /// Whether a muscle is active or was within the hold time. Call after [`tick`](Self::tick).
    #[must_use]
    pub const fn is_active(&self) -> bool {
        self.hold > 0
    }

    /// Whether both sensors can be believed, so that "not active" is known and not just unseen.
    #[must_use]
    pub const fn is_known(&self) -> bool {
        self.verdict.known
    }

    /// Whether both could be for as long as a muscle's activity is held: before, it could have ended unseen.
    #[must_use]
    pub const fn is_certain(&self, config: &GateConfig) -> bool {
        self.known_frames >= config.hold_frames
    }

    /// The flexor's envelope above rest, mV.
    #[must_use]
    pub const fn flexor_mv(&self) -> Option<i16> {
        self.mv[0]
    }

    /// The extensor's.
    #[must_use]
    pub const fn extensor_mv(&self) -> Option<i16> {
        self.mv[1]
    }

    /// Whether both muscles are above the level of activity, whatever they ask for.
    #[must_use]
    pub fn is_co_contracted(&self, config: &GateConfig) -> bool {
        self.is_known()
            && self.mv.iter().all(|mv| mv.is_some_and(|mv| i32::from(mv) >= i32::from(config.on_mv)))
    }

    /// What the muscles ask for, the faster the stronger they do.
    #[must_use]
    pub fn wish(&self, config: &GateConfig) -> MotorDrive {
        match self.verdict.wish {
            Wish::Rest => MotorDrive::Coast,
            Wish::Close => MotorDrive::Close(duty(config, self.verdict.strength_permille)),
            Wish::Open => MotorDrive::Open(duty(config, self.verdict.strength_permille)),
        }
    }
}

/// The slowest duty at the weakest contraction that is a wish, all of it at the strongest. The strength is a difference of
/// logarithms: its square is about proportional to the envelope over the decade between, and a light contraction is slow.
fn duty(config: &GateConfig, strength_permille: u16) -> Duty {
    let slowest = u32::from(config.slowest_permille.min(1_000));
    let strength = u32::from(strength_permille.min(1_000));
    let permille = slowest + strength * strength / 1_000 * (1_000 - slowest) / 1_000;
    Duty::per_mille(permille as u16)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONFIG: GateConfig = GateConfig { on_mv: 160, hold_frames: 400, slowest_permille: 300 };

    fn says(wish: Wish, strength_permille: u16) -> Gate {
        let mut gate = Gate::default();
        gate.take(Verdict { wish, strength_permille, active: wish != Wish::Rest, known: true });
        gate.tick(&CONFIG);
        gate
    }

    #[test]
    fn the_defaults_are_the_tests_numbers() {
        assert_eq!(crate::config::Config::default().gate, CONFIG);
    }

    #[test]
    fn each_wish_has_its_direction_and_the_duty_follows_its_strength() {
        assert_eq!(says(Wish::Rest, 0).wish(&CONFIG), MotorDrive::Coast);
        assert_eq!(says(Wish::Close, 1_000).wish(&CONFIG), MotorDrive::Close(Duty::FULL));
        assert_eq!(says(Wish::Open, 0).wish(&CONFIG), MotorDrive::Open(Duty::per_mille(300)));
        assert_eq!(says(Wish::Close, 500).wish(&CONFIG), MotorDrive::Close(Duty::per_mille(475)));
    }

    #[test]
    fn activity_is_held() {
        let mut gate = says(Wish::Open, 100);
        gate.take(Verdict { known: true, ..Verdict::default() });
        assert_eq!(gate.wish(&CONFIG), MotorDrive::Coast);
        for _ in 0..399 {
            gate.tick(&CONFIG);
            assert!(gate.is_active());
        }
        gate.tick(&CONFIG);
        assert!(!gate.is_active());
    }

    #[test]
    fn what_is_known_is_certain_after_the_hold_time() {
        let mut gate = says(Wish::Rest, 0);
        (1..400).for_each(|_| gate.tick(&CONFIG));
        assert!(gate.is_certain(&CONFIG));
        gate.take(Verdict::default());
        gate.tick(&CONFIG);
        assert!(!gate.is_certain(&CONFIG) && !gate.is_known());
    }
}
