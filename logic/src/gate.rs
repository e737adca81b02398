//! The myoelectric gate: the wearer's drive, and whether a muscle is active, held for a while so that the
//! reflex stays silent between two contractions (Prosthesis, section 5). An unproven wish moves a hand that
//! may hold something slowly and by little, so that a fault of an electrode drops nothing.

use tenax_hal_shim::motor::{Duty, MotorDrive};

use crate::account::Account;
use crate::emg::Verdict;
use crate::emg::decide::Wish;
use crate::emg::settings::GateConfig;

/// Longest opening of a release, frames: 4 s, the whole range at the slowest duty; and once nothing is felt.
const RELEASE_FRAMES: u32 = 8_000;
const RELEASED_FRAMES: u32 = 1_000;

#[derive(Clone, Copy, Debug, Default)]
pub struct Gate {
    verdict: Verdict,
    mv: [Option<i16>; 2],
    hold: u32,
    known_frames: u32,
    half_known_frames: u32,
    empty: bool,
    release: u32,
}

impl Gate {
    pub const fn take(&mut self, verdict: Verdict) {
        self.verdict = verdict;
    }

    /// Envelope above rest, mV, for telemetry. Muscle 0 is the flexor, others the extensor.
    pub const fn show(&mut self, muscle: usize, mv: Option<i16>) {
        self.mv[if muscle == 0 { 0 } else { 1 }] = mv;
    }

    /// The hand opens slowly, whatever the sensors say, until nothing is felt or a muscle closes it.
    pub const fn release(&mut self, on: bool) {
        self.release = if on { RELEASE_FRAMES } else { 0 };
    }

    pub fn step_release(&mut self, frames: u32) {
        let most = if self.empty { RELEASED_FRAMES } else { RELEASE_FRAMES };
        let closes = matches!(self.verdict, Verdict { wish: Wish::Close, proven: true, .. });
        self.release = if closes { 0 } else { self.release.saturating_sub(frames).min(most) };
    }

    pub const fn verdict(&self) -> &Verdict {
        &self.verdict
    }

    pub const fn is_releasing(&self) -> bool {
        self.release > 0
    }

    /// `empty`: the finger is known to touch nothing.
    pub fn tick(&mut self, config: &GateConfig, empty: bool) {
        if self.verdict.active || self.release > 0 {
            self.hold = config.hold_frames;
        } else {
            self.hold = self.hold.saturating_sub(1);
        }
        self.known_frames = if self.is_known() { self.known_frames.saturating_add(1) } else { 0 };
        self.half_known_frames =
            if self.verdict.half_known { self.half_known_frames.saturating_add(1) } else { 0 };
        self.empty = empty;
    }

    /// A proven wish, or nothing to drop or crush.
    pub const fn is_trusted(&self) -> bool {
        self.verdict.proven || self.empty
    }

    /// Active, or within the hold time. Call it after [`tick`](Self::tick).
    pub const fn is_active(&self) -> bool {
        self.hold > 0
    }

    /// Both myosensors are healthy, so that "not active" is known.
    pub const fn is_known(&self) -> bool {
        self.verdict.known
    }

    /// Healthy for the hold time, so that no earlier activity can have been missed.
    pub const fn is_certain(&self, config: &GateConfig) -> bool {
        self.known_frames >= config.hold_frames
    }

    /// One healthy myosensor beside a lost one that cannot be an active muscle, for the hold time.
    pub const fn is_half_certain(&self, config: &GateConfig) -> bool {
        self.half_known_frames >= config.hold_frames
    }

    pub const fn flexor_mv(&self) -> Option<i16> {
        self.mv[0]
    }

    pub const fn extensor_mv(&self) -> Option<i16> {
        self.mv[1]
    }

    /// Both muscles above `emg-on-mv`, whatever they ask for.
    pub fn is_co_contracted(&self, config: &GateConfig) -> bool {
        self.is_known()
            && self.mv.iter().all(|mv| mv.is_some_and(|mv| i32::from(mv) >= i32::from(config.on_mv)))
    }

    /// Faster for a stronger contraction; an unproven opening at the slowest duty.
    pub fn wish(&self, config: &GateConfig, account: &Account) -> MotorDrive {
        let (trusted, slowest) = (self.is_trusted(), duty(config, 0));
        match self.verdict.wish {
            Wish::Open if trusted => MotorDrive::Open(duty(config, self.verdict.strength_permille)),
            _ if self.release > 0 => MotorDrive::Open(slowest),
            Wish::Open if account.may_open(slowest) => MotorDrive::Open(slowest),
            Wish::Close if trusted || account.may_close() => {
                MotorDrive::Close(duty(config, self.verdict.strength_permille))
            }
            _ => MotorDrive::Coast,
        }
    }
}

/// Slowest at the weakest wish, full at the strongest. Strength is a difference of logarithms; its square is
/// about proportional to the envelope over a decade.
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
        let active = wish != Wish::Rest;
        let verdict = Verdict { wish, strength_permille, proven: active, active, ..Verdict::default() };
        gate.take(Verdict { known: true, half_known: true, ..verdict });
        gate.tick(&CONFIG, false);
        gate
    }

    fn wishes(gate: &Gate) -> MotorDrive {
        gate.wish(&CONFIG, &Account::default())
    }

    #[test]
    fn the_defaults_are_the_tests_numbers() {
        assert_eq!(crate::config::Config::default().gate, CONFIG);
    }

    #[test]
    fn each_wish_has_its_direction_and_the_duty_follows_its_strength() {
        assert_eq!(wishes(&says(Wish::Rest, 0)), MotorDrive::Coast);
        assert_eq!(wishes(&says(Wish::Close, 1_000)), MotorDrive::Close(Duty::FULL));
        assert_eq!(wishes(&says(Wish::Open, 0)), MotorDrive::Open(Duty::per_mille(300)));
        assert_eq!(wishes(&says(Wish::Close, 500)), MotorDrive::Close(Duty::per_mille(475)));
    }

    #[test]
    fn activity_is_held() {
        let mut gate = says(Wish::Open, 100);
        gate.take(Verdict { known: true, half_known: true, ..Verdict::default() });
        assert_eq!(wishes(&gate), MotorDrive::Coast);
        for _ in 0..399 {
            gate.tick(&CONFIG, false);
            assert!(gate.is_active());
        }
        gate.tick(&CONFIG, false);
        assert!(!gate.is_active());
    }

    #[test]
    fn both_envelopes_are_shown_and_co_contract_from_the_level_on_where_both_are_known() {
        let mut gate = says(Wish::Rest, 0);
        let mut co_contract = |mv: [Option<i16>; 2]| {
            (0..).zip(mv).for_each(|(muscle, mv)| gate.show(muscle, mv));
            assert_eq!([gate.flexor_mv(), gate.extensor_mv()], mv);
            gate.is_co_contracted(&CONFIG)
        };
        assert!(co_contract([Some(200), Some(160)]));
        assert!(!co_contract([Some(200), Some(159)]) && !co_contract([None, Some(200)]));
        assert!(co_contract([Some(160), Some(2_000)]));
        gate.take(Verdict::default());
        assert!(!gate.is_co_contracted(&CONFIG));
    }

    // Shows W8.
    #[test]
    fn a_release_opens_slowly_until_its_time_is_over_nothing_is_felt_or_a_muscle_closes() {
        let slowly = MotorDrive::Open(Duty::per_mille(300));
        let mut gate = says(Wish::Rest, 0);
        assert!(!gate.is_releasing() && !gate.is_active());
        let mut lasts = |empty: bool| {
            gate.release(true);
            gate.tick(&CONFIG, empty);
            let mut frames = 0;
            while gate.is_releasing() && frames <= RELEASE_FRAMES {
                assert_eq!(wishes(&gate), slowly);
                gate.tick(&CONFIG, empty);
                assert!(gate.is_active(), "the reflex is silent");
                gate.step_release(1);
                frames += 1;
            }
            frames
        };
        assert_eq!((lasts(false), lasts(true)), (RELEASE_FRAMES, RELEASED_FRAMES + 1));
        assert_eq!(wishes(&gate), MotorDrive::Coast);

        let closes = Verdict { wish: Wish::Close, active: true, known: true, ..Verdict::default() };
        for (verdict, goes_on) in [(closes, true), (Verdict { proven: true, ..closes }, false)] {
            gate.release(true);
            gate.take(verdict);
            gate.step_release(1);
            assert_eq!(gate.is_releasing(), goes_on, "{verdict:?}");
        }
        gate.release(true);
        gate.release(false);
        assert!(!gate.is_releasing());
    }

    #[test]
    fn certainty_takes_as_long_as_activity_is_held_and_begins_anew() {
        let mut gate = Gate::default();
        let half = Verdict { half_known: true, ..Verdict::default() };
        let mut after = |verdict: Verdict, frames: u32| {
            gate.take(verdict);
            (0..frames).for_each(|_| gate.tick(&CONFIG, false));
            (gate.is_certain(&CONFIG), gate.is_half_certain(&CONFIG))
        };
        assert_eq!(after(half, CONFIG.hold_frames - 1), (false, false));
        assert_eq!(after(half, 1), (false, true));
        assert_eq!(after(Verdict { known: true, ..half }, CONFIG.hold_frames), (true, true));
        assert_eq!(after(Verdict::default(), 1), (false, false));
    }
}
