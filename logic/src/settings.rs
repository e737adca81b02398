//! Where each setting of [`hal_shim::setting`](tenax_hal_shim::setting) lives in the configuration, and how its unit is
//! converted to the logic's own.

use core::ops::RangeInclusive;

use tenax_hal_shim::channel::{FRAME_HZ, mv_from_sample, sample_from_mv};
use tenax_hal_shim::setting::SettingId;

use crate::config::{Config, frames};
use crate::hebbian::Rule;

impl Config {
    /// A setting's value, in its unit.
    #[must_use]
    pub fn get(&self, id: SettingId) -> i32 {
        use SettingId as Id;
        match id {
            Id::S1 => mv(self.vibration.s1),
            Id::KnockLevel => mv(self.vibration.knock_level),
            Id::KnockRatio => self.vibration.knock_permille.into(),
            Id::KnockLength => ms(self.vibration.knock_frames),
            Id::Mains60Hz => self.vibration.mains_60_hz.into(),
            Id::S2 => self.friction.s2_permille.into(),
            Id::S2OfMuS => self.friction.s2_of_mu_s_permille.into(),
            Id::Loaded => self.friction.loaded_mn,
            Id::HebbianSlip => self.touch.slip_permille.into(),
            Id::HebbianTime => ms(self.touch.slip_frames),
            Id::HebbianEverywhere => ms(self.touch.everywhere_frames),
            Id::HebbianAfterNoise => ms(self.touch.loud_frames),
            Id::NoisyDuty => self.touch.loud_duty_permille.into(),
            Id::TeacherFresh => self.touch.teacher.fresh_ms.into(),
            Id::HebbianAhead => self.touch.ahead_ms.into(),
            Id::HebbianAlpha => self.touch.learning.alpha_ppb as i32,
            Id::HebbianBeta => self.touch.learning.beta_ppb as i32,
            Id::HebbianDelta => self.touch.learning.delta_ppm as i32,
            Id::EmgOn => self.gate.on_mv.into(),
            Id::EmgHold => ms(self.gate.hold_frames),
            Id::EmgSlowest => self.gate.slowest_permille.into(),
            Id::ForceCeiling => self.grip.ceiling_mn,
            Id::SlipDuty => self.grip.slip_duty_permille.into(),
            Id::SlipPulse => ms(self.grip.slip_frames),
            Id::SlipPulseMax => ms(self.grip.slip_frames_max),
            Id::IncipientDuty => self.grip.incipient_duty_permille.into(),
            Id::IncipientPulse => ms(self.grip.incipient_frames),
            Id::Settle => ms(self.grip.settle_frames),
            Id::Blind => ms(self.grip.blind_frames),
            Id::BehaviourDuty => self.behaviour.duty_permille.into(),
            Id::BehaviourMovement => ms(self.behaviour.movement_frames),
            Id::BehaviourWait => ms(self.behaviour.wait_frames),
            Id::GentleScore => self.behaviour.gentle_score.into(),
            Id::ChangedCells => self.behaviour.changed_cells.into(),
            Id::MovingPoints => self.behaviour.moving_e4.into(),
            Id::TurnLead => ms(self.behaviour.turn_lead_frames),
            Id::LineTrusted => self.line_trusted.into(),
            Id::StreamAtStart => self.stream_at_start.into(),
            Id::NoWearer => self.no_wearer.into(),
            Id::Head => self.head.fitted.into(),
            Id::HeadSlip => mv(self.head.slip),
            Id::HeadDark => mv_of_q4(self.head.curve.dark_q4),
            Id::HeadBright => mv_of_q4(self.head.curve.bright_q4),
            Id::HeadForce1 => self.head.curve.force_mn[0],
            Id::HeadForce2 => self.head.curve.force_mn[1],
            Id::HeadForce3 => self.head.curve.force_mn[2],
            Id::HeadForce4 => self.head.curve.force_mn[3],
            Id::HeadForce5 => self.head.curve.force_mn[4],
            Id::HeadForce6 => self.head.curve.force_mn[5],
            Id::HeadForce7 => self.head.curve.force_mn[6],
            Id::HeadForce8 => self.head.curve.force_mn[7],
        }
    }

    /// Changes a setting.
    ///
    /// # Errors
    /// If the value is not accepted: the values that are. Then nothing has changed.
    pub fn set(&mut self, id: SettingId, value: i32) -> Result<(), RangeInclusive<i32>> {
        let range = self.range(id);
        if !range.contains(&value) {
            return Err(range);
        }
        self.put(id, value);
        if id == SettingId::LineTrusted {
            self.bound();
        }
        Ok(())
    }

    /// The values of a setting that are accepted now.
    const fn range(&self, id: SettingId) -> RangeInclusive<i32> {
        if self.line_trusted { id.row().range_if_trusted() } else { id.row().range() }
    }

    /// Whoever relies on consent relies on the narrower ranges too.
    fn bound(&mut self) {
        for id in SettingId::ALL {
            let (value, max) = (self.get(id), *self.range(id).end());
            if value > max {
                self.put(id, max);
            }
        }
    }

    /// Changes a setting to a value that is accepted: 0 to 2^24, which each field has room for.
    pub(crate) fn put(&mut self, id: SettingId, value: i32) {
        use SettingId as Id;
        let number = value.unsigned_abs();
        let small = number.min(u32::from(u16::MAX)) as u16;
        match id {
            Id::S1 => self.vibration.s1 = sample_from_mv(number),
            Id::KnockLevel => self.vibration.knock_level = sample_from_mv(number),
            Id::KnockRatio => self.vibration.knock_permille = small,
            Id::KnockLength => self.vibration.knock_frames = frames(number),
            Id::Mains60Hz => self.vibration.mains_60_hz = number == 1,
            Id::S2 => self.friction.s2_permille = small,
            Id::S2OfMuS => self.friction.s2_of_mu_s_permille = small,
            Id::Loaded => self.friction.loaded_mn = value,
            Id::HebbianSlip => self.touch.slip_permille = small,
            Id::HebbianTime => self.touch.slip_frames = frames(number),
            Id::HebbianEverywhere => self.touch.everywhere_frames = frames(number),
            Id::HebbianAfterNoise => self.touch.loud_frames = frames(number),
            Id::NoisyDuty => self.touch.loud_duty_permille = small,
            Id::TeacherFresh => self.touch.teacher.fresh_ms = small,
            Id::HebbianAhead => self.touch.ahead_ms = small,
            Id::HebbianAlpha => self.touch.learning.alpha_ppb = number,
            Id::HebbianBeta => self.touch.learning.beta_ppb = number,
            Id::HebbianDelta => self.touch.learning.delta_ppm = number,
            Id::EmgOn => self.gate.on_mv = small,
            Id::EmgHold => self.gate.hold_frames = frames(number),
            Id::EmgSlowest => self.gate.slowest_permille = small,
            Id::ForceCeiling => self.grip.ceiling_mn = value,
            Id::SlipDuty => self.grip.slip_duty_permille = small,
            Id::SlipPulse => self.grip.slip_frames = frames(number),
            Id::SlipPulseMax => self.grip.slip_frames_max = frames(number),
            Id::IncipientDuty => self.grip.incipient_duty_permille = small,
            Id::IncipientPulse => self.grip.incipient_frames = frames(number),
            Id::Settle => self.grip.settle_frames = frames(number),
            Id::Blind => self.grip.blind_frames = frames(number),
            Id::BehaviourDuty => self.behaviour.duty_permille = small,
            Id::BehaviourMovement => self.behaviour.movement_frames = frames(number),
            Id::BehaviourWait => self.behaviour.wait_frames = frames(number),
            Id::GentleScore => self.behaviour.gentle_score = small,
            Id::ChangedCells => self.behaviour.changed_cells = small,
            Id::MovingPoints => self.behaviour.moving_e4 = small,
            Id::TurnLead => self.behaviour.turn_lead_frames = frames(number),
            Id::LineTrusted => self.line_trusted = number > 0,
            Id::StreamAtStart => self.stream_at_start = number > 0,
            Id::NoWearer => self.no_wearer = number > 0,
            Id::Head => self.head.fitted = number > 0,
            Id::HeadSlip => self.head.slip = sample_from_mv(number),
            Id::HeadDark => self.head.curve.dark_q4 = i32::from(sample_from_mv(number)) << 4,
            Id::HeadBright => self.head.curve.bright_q4 = i32::from(sample_from_mv(number)) << 4,
            Id::HeadForce1 => self.head.curve.force_mn[0] = value,
            Id::HeadForce2 => self.head.curve.force_mn[1] = value,
            Id::HeadForce3 => self.head.curve.force_mn[2] = value,
            Id::HeadForce4 => self.head.curve.force_mn[3] = value,
            Id::HeadForce5 => self.head.curve.force_mn[4] = value,
            Id::HeadForce6 => self.head.curve.force_mn[5] = value,
            Id::HeadForce7 => self.head.curve.force_mn[6] = value,
            Id::HeadForce8 => self.head.curve.force_mn[7] = value,
        }
        if matches!(id, Id::HebbianAlpha | Id::HebbianBeta | Id::HebbianDelta) {
            self.touch.rule = Rule::of(&self.touch.learning);
        }
    }
}

/// A 14-bit sample has more steps than there are millivolts: each comes back as it was set.
fn mv(sample: u16) -> i32 {
    mv_from_sample(sample) as i32
}

fn mv_of_q4(level_q4: i32) -> i32 {
    mv((level_q4 >> 4) as u16)
}

fn ms(frames: u32) -> i32 {
    (frames * 1_000 / FRAME_HZ) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_setting_is_a_number_of_its_own_and_comes_back_as_it_was_set() {
        for id in SettingId::ALL {
            let row = id.row();
            assert_eq!(Config::default().get(id), row.default, "{}", row.name);
            let steps = 1 + (row.max - row.min) / 997;
            for value in (row.min..=row.max).step_by(steps as usize).chain([row.max]) {
                let mut config = Config::default();
                assert_eq!(config.set(id, value), Ok(()));
                assert_eq!(config.get(id), value, "{}", row.name);
                for other in SettingId::ALL.into_iter().filter(|other| *other != id) {
                    assert_eq!(config.get(other), other.row().default, "{} moved {other:?}", row.name);
                }
            }
        }
    }

    #[test]
    fn a_trusted_line_may_silence_a_detector_until_it_is_trusted_no_more() {
        let mut config = Config { line_trusted: true, ..Config::default() };
        assert_eq!(config.set(SettingId::S1, 1_500), Ok(()));
        assert_eq!(config.set(SettingId::S2, 800), Ok(()));
        assert_eq!(config.set(SettingId::LineTrusted, 0), Ok(()));
        assert_eq!((config.get(SettingId::S1), config.get(SettingId::S2)), (250, 800));
        assert_eq!(config.set(SettingId::S1, 1_500), Err(20..=250));
    }

    #[test]
    fn a_value_out_of_range_changes_nothing_and_names_the_range() {
        for id in SettingId::ALL {
            let row = id.row();
            for value in [i32::MIN, -1, row.min - 1, row.max + 1, i32::MAX] {
                let mut config = Config::default();
                assert_eq!(config.set(id, value), Err(row.min..=row.max), "{}", row.name);
                assert_eq!(config, Config::default());
            }
        }
    }
}
