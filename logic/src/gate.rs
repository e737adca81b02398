//! The myoelectric gate: what the wearer's two muscles ask for, and whether they ask for anything (Prosthesis,
//! section 5: "the sensor system should be activated only in case the myosensors are not active").
//!
//! A single reading above the threshold already silences the reflex. To move the hand takes two in a row that differ:
//! they come at most 6.5 ms apart, and a glitch or a frozen sensor is not a wish. When both muscles are active, the
//! clearly stronger one is meant, and without one (co-contraction) the hand rests.

use tenax_hal_shim::channel::mv_from_sample;
use tenax_hal_shim::front_end::MYO_REST_MV;
use tenax_hal_shim::motor::{Duty, MotorDrive};

use crate::config::GateConfig;

/// The stronger of two active muscles is meant if it is this much stronger, per mille.
pub const DOMINANCE_PERMILLE: i32 = 1_500;

/// One muscle's sensor.
#[derive(Clone, Copy, Debug, Default)]
pub struct Muscle {
    mv: Option<i16>,
    sample: u16,
    active: bool,
    confirmed: bool,
}

impl Muscle {
    /// Takes a reading: a sample, or none where the sensor gives no number.
    pub fn take(&mut self, config: &GateConfig, reading: Option<u16>) {
        let Some(sample) = reading else {
            *self = Self::default();
            return;
        };
        let mv = mv_from_sample(sample) as i32 - MYO_REST_MV as i32;
        let on = i32::from(config.on_mv);
        let was_active = self.active;
        self.active = mv >= if was_active { on * i32::from(config.off_permille) / 1_000 } else { on };
        self.confirmed = self.active && (self.confirmed || (was_active && sample != self.sample));
        self.sample = sample;
        self.mv = Some(mv as i16);
    }

    /// Envelope above rest, mV.
    #[must_use]
    pub const fn mv(&self) -> Option<i16> {
        self.mv
    }

    /// Whether its last reading was above the threshold.
    #[must_use]
    pub const fn is_active(&self) -> bool {
        self.active
    }

    /// How strongly it is meant, mV: 0 unless active.
    fn strength(&self) -> i32 {
        if self.active { i32::from(self.mv.unwrap_or(0)) } else { 0 }
    }
}

/// Both muscles.
#[derive(Clone, Copy, Debug, Default)]
pub struct Gate {
    /// Closes the hand.
    pub flexor: Muscle,
    /// Opens it.
    pub extensor: Muscle,
    hold: u32,
    known_frames: u32,
}

impl Gate {
    /// The muscle of this select, counted from the flexor's: 0 the flexor, others the extensor.
    pub(crate) const fn muscle_mut(&mut self, muscle: usize) -> &mut Muscle {
        if muscle == 0 { &mut self.flexor } else { &mut self.extensor }
    }

    /// Goes on by one frame.
    pub fn tick(&mut self, config: &GateConfig) {
        if self.flexor.active || self.extensor.active {
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

    /// Whether both sensors give numbers, so that "not active" is known and not just unseen.
    #[must_use]
    pub const fn is_known(&self) -> bool {
        self.flexor.mv.is_some() && self.extensor.mv.is_some()
    }

    /// Whether both have given numbers for as long as a muscle's activity is held: before, it could have ended unseen.
    #[must_use]
    pub const fn is_certain(&self, config: &GateConfig) -> bool {
        self.known_frames >= config.hold_frames
    }

    /// What the muscles ask for.
    #[must_use]
    pub fn wish(&self, config: &GateConfig) -> MotorDrive {
        let (close, open) = (self.flexor.strength(), self.extensor.strength());
        let dominates = |a: i32, b: i32| a * 1_000 > b * DOMINANCE_PERMILLE;
        if self.extensor.confirmed && dominates(open, close) {
            MotorDrive::Open(duty(config, open))
        } else if self.flexor.confirmed && dominates(close, open) {
            MotorDrive::Close(duty(config, close))
        } else {
            MotorDrive::Coast
        }
    }
}

/// Proportional: the slowest duty at the threshold, all of it at `full_mv`.
fn duty(config: &GateConfig, mv: i32) -> Duty {
    let (on, full) = (i32::from(config.on_mv), i32::from(config.full_mv));
    let slowest = i32::from(config.slowest_permille);
    let span = (full - on).max(1);
    let permille = slowest + (mv - on).clamp(0, span) * (1_000 - slowest) / span;
    Duty::per_mille(permille.clamp(0, 1_000) as u16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use tenax_hal_shim::channel::sample_from_mv;

    const CONFIG: GateConfig =
        GateConfig { on_mv: 160, off_permille: 700, hold_frames: 400, full_mv: 1_000, slowest_permille: 300 };

    fn at(mv: u32) -> Option<u16> {
        Some(sample_from_mv(MYO_REST_MV + mv))
    }

    fn gate(flexor: [u32; 2], extensor: [u32; 2]) -> Gate {
        let mut gate = Gate::default();
        for n in 0..2 {
            gate.flexor.take(&CONFIG, at(flexor[n]));
            gate.extensor.take(&CONFIG, at(extensor[n]));
            gate.tick(&CONFIG);
        }
        gate
    }

    #[test]
    fn the_defaults_are_the_tests_numbers() {
        assert_eq!(Config::default().gate, CONFIG);
    }

    #[test]
    fn each_muscle_has_its_direction_and_the_duty_follows_it() {
        assert_eq!(gate([40, 45], [40, 45]).wish(&CONFIG), MotorDrive::Coast);
        assert_eq!(gate([990, 1_000], [40, 45]).wish(&CONFIG), MotorDrive::Close(Duty::FULL));
        assert!(gate([40, 45], [180, 170]).wish(&CONFIG).opens());
        let (slow, fast) = (gate([170, 171], [0; 2]).wish(&CONFIG), gate([500, 510], [0; 2]).wish(&CONFIG));
        match (slow, fast) {
            (MotorDrive::Close(slow), MotorDrive::Close(fast)) => assert!(slow < fast),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn co_contraction_rests_and_is_activity() {
        let both = gate([600, 610], [600, 590]);
        assert_eq!(both.wish(&CONFIG), MotorDrive::Coast);
        assert!(both.is_active());
    }

    #[test]
    fn a_frozen_sensor_is_no_wish_but_silences() {
        let frozen = gate([40, 45], [800, 800]);
        assert_eq!(frozen.wish(&CONFIG), MotorDrive::Coast);
        assert!(frozen.is_active());
    }

    #[test]
    fn hysteresis_and_hold() {
        let mut gate = gate([40, 45], [200, 201]);
        gate.extensor.take(&CONFIG, at(120));
        assert!(gate.wish(&CONFIG).opens(), "above the lower threshold it stays active");
        gate.extensor.take(&CONFIG, at(100));
        assert_eq!(gate.wish(&CONFIG), MotorDrive::Coast);
        for _ in 0..399 {
            gate.tick(&CONFIG);
            assert!(gate.is_active());
        }
        gate.tick(&CONFIG);
        assert!(!gate.is_active());
    }

    #[test]
    fn a_sensor_without_a_number_asks_for_nothing_and_is_not_known_to_rest() {
        let mut gate = gate([40, 45], [800, 810]);
        gate.extensor.take(&CONFIG, None);
        assert_eq!(gate.wish(&CONFIG), MotorDrive::Coast);
        assert!(!gate.is_known());
    }
}
