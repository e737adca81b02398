//! The grip reflex: how much to close on slip or incipient slip.
//!
//! A pulse ends when the missing force ([`Lacks`]) is there: by the measured force plus the travel that it
//! does not show yet times the stiffness ([`Stiffness`]). Where that is unknown, a pulse has the set length.
//! After a pulse against slip the object settles for longer than the motor's dead time. No pulse begins on a
//! finger that holds nothing or is at the force ceiling; while the force is unknown, all pulses share the blind
//! budget of the [`Account`].

pub mod lacks;
pub mod relax;
pub mod settings;
mod stiffness;

use tenax_hal_shim::channel::frames;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::words::GripMode;

use self::lacks::{Lacks, Slides};
use self::relax::Relax;
use self::settings::GripConfig;
use self::stiffness::Stiffness;
use crate::account::Account;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Grip {
    #[default]
    Unknown,
    Unloaded,
    /// mN.
    Holds(i32),
}

/// Part of the load by which a pulse has to change it: beyond the force sensor's noise.
const RAISES_PART: i32 = 200;
/// Pulses in a row without effect, after which no warning is answered until the load changes or a muscle was
/// active.
const IN_VAIN_MAX: u16 = 8;

/// Shortest pulse: 3 ms.
const LEAST_FRAMES: u32 = 6;
/// Slip that is reported again within this continues: its pulse is at least twice as long as the one before,
/// up to 48 ms.
const AT_ONCE_FRAMES: u32 = 60;
const ROW_MAX: u8 = 5;
/// Time after a report of slip until Ft/Fn is the sliding friction: two readings.
const SHOWS_FRAMES: u32 = frames(25);

#[derive(Clone, Copy, Debug)]
pub struct Reflex {
    elapsed: u32,
    /// Frames since the last pulse that answered incipient slip, saturating.
    since_incipient: u32,
    pub account: Account,
    /// Closing spends the budget though the force is known.
    bound: bool,
    /// Load as the last pulse began, mN, and the pulses in a row that raised nothing.
    began_mn: Option<i32>,
    in_vain: u16,
    stiffness: Stiffness,
    relax: Relax,
    lacks: Lacks,
    /// Travel left of the pulse, per mille of duty times frames. None: the pulse has the set length.
    left: Option<u32>,
    /// Pulses that answered slip in a row, each as soon as the one before had settled.
    row: u8,
}

impl Default for Reflex {
    fn default() -> Self {
        Self {
            elapsed: 0,
            since_incipient: u32::MAX,
            account: Account::default(),
            bound: false,
            began_mn: None,
            in_vain: 0,
            stiffness: Stiffness::default(),
            relax: Relax::default(),
            lacks: Lacks::default(),
            left: None,
            row: 0,
        }
    }
}

impl Reflex {
    /// Something is held below the force ceiling, and blind budget is left if it is needed.
    pub const fn may_close(&self, config: &GripConfig, grip: Grip) -> bool {
        match grip {
            Grip::Unknown => self.has_budget(config),
            Grip::Unloaded => false,
            Grip::Holds(mn) => mn < config.ceiling_mn && (!self.bound || self.has_budget(config)),
        }
    }

    const fn has_budget(&self, config: &GripConfig) -> bool {
        self.account.blind < config.blind_frames
    }

    /// An electrode is lost, and a muscle might be missed: closing spends the blind budget even if the force
    /// is known.
    pub const fn bind(&mut self, bound: bool) {
        self.bound = bound;
    }

    /// Below the force ceiling, or with blind budget left if the force is unknown.
    pub const fn link_may_close(&self, config: &GripConfig, grip: Grip) -> bool {
        match grip {
            Grip::Unknown => self.has_budget(config),
            Grip::Unloaded => true,
            Grip::Holds(mn) => mn < config.ceiling_mn,
        }
    }

    /// Call it once at each change of mode.
    #[inline(never)]
    pub fn enter(&mut self, mode: GripMode, grip: Grip) {
        match mode {
            GripMode::Slip if self.elapsed >= AT_ONCE_FRAMES => self.row = 1,
            GripMode::Slip => self.row = self.row.saturating_add(1).min(ROW_MAX),
            GripMode::Wearer | GripMode::Standby | GripMode::Incipient => self.row = 0,
            GripMode::Watch | GripMode::Settle => {}
        }
        self.elapsed = 0;
        if crate::mode::closes(mode)
            && let Grip::Holds(mn) = grip
        {
            self.in_vain = if self.has_changed(mn) { 0 } else { self.in_vain.saturating_add(1) };
            self.began_mn = Some(mn);
        }
        self.size(mode);
    }

    fn has_changed(&self, load_mn: i32) -> bool {
        self.began_mn.is_none_or(|began| (load_mn - began).abs() > began / RAISES_PART)
    }

    /// Call it once a slow frame. `load_mn` None: unknown, or nothing is held.
    #[inline(never)]
    pub fn feel(&mut self, mode: GripMode, load_mn: Option<i32>, lacks: Lacks) {
        self.stiffness.feel(load_mn);
        if load_mn.is_none() {
            (self.began_mn, self.in_vain) = (None, 0);
        }
        self.lacks = lacks;
        self.size(mode);
    }

    pub const fn slides(&self, mode: GripMode) -> Slides {
        match mode {
            GripMode::Slip if self.row > 1 => Slides::Again,
            GripMode::Slip if self.elapsed >= SHOWS_FRAMES => Slides::Now,
            GripMode::Settle if self.row > 0 => Slides::Again,
            GripMode::Watch if self.row > 0 && self.elapsed < AT_ONCE_FRAMES => Slides::Again,
            _ => Slides::Unknown,
        }
    }

    #[inline(never)]
    fn size(&mut self, mode: GripMode) {
        let lacks_mn = match mode {
            GripMode::Slip => self.lacks.slip_mn,
            GripMode::Incipient => self.lacks.warning_mn,
            _ => None,
        };
        // A pulse at most doubles the load at its begin.
        let most_mn = self.began_mn.unwrap_or(0);
        self.left = lacks_mn.and_then(|lacks_mn| self.stiffness.travel_for(lacks_mn.min(most_mn)));
    }

    /// Call it in each frame in which the motor closes. Only what the reflex closed may be released later.
    pub fn closes(&mut self, duty: Duty, by_reflex: bool) {
        self.stiffness.close(duty.as_per_mille());
        if by_reflex {
            self.relax.closes(duty.as_per_mille());
        } else {
            self.relax.forget();
        }
        if let Some(left) = self.left {
            self.left = Some(left.saturating_sub(duty.as_per_mille() as u32));
        }
    }

    /// Releases added force in mode `Watch`. `held` None: another source moves the hand, or it holds nothing.
    /// Call it once a slow frame, after [`feel`](Self::feel).
    #[inline(never)]
    pub fn relax(&mut self, mode: GripMode, held: Option<&relax::Reading>) {
        match (mode, held) {
            (GripMode::Watch, Some(reading)) => self.relax.feel(reading, &self.stiffness),
            (GripMode::Slip | GripMode::Incipient | GripMode::Settle, Some(_)) => {}
            _ => self.relax.forget(),
        }
    }

    pub const fn is_relaxing(&self) -> bool {
        self.relax.is_on()
    }

    pub fn hear(&mut self) {
        self.relax.hear();
    }

    pub fn relaxes(&mut self) -> MotorDrive {
        match self.relax.opens() {
            0 => MotorDrive::Coast,
            duty => MotorDrive::Open(Duty::per_mille(duty)),
        }
    }

    /// A muscle is active: warnings that were in vain are answered anew.
    pub const fn renew(&mut self) {
        (self.began_mn, self.in_vain) = (None, 0);
    }

    pub fn spend(&mut self, grip: Grip) {
        if grip == Grip::Unknown {
            self.account.blind = self.account.blind.saturating_add(1);
        }
    }

    pub const fn elapsed(&self) -> u32 {
        self.elapsed
    }

    pub fn tick(&mut self, mode: GripMode, grip: Grip) {
        self.elapsed = self.elapsed.saturating_add(1);
        self.since_incipient = self.since_incipient.saturating_add(1);
        if mode == GripMode::Incipient {
            self.since_incipient = 0;
        }
        if crate::mode::closes(mode) {
            self.spend(if self.bound { Grip::Unknown } else { grip });
        }
    }

    pub const fn pulse_over(&self, config: &GripConfig, mode: GripMode, slips: bool, grip: Grip) -> bool {
        let length = match mode {
            GripMode::Slip if slips => config.slip_frames_max,
            GripMode::Slip => config.slip_frames,
            GripMode::Incipient if self.left.is_some() && self.lacks.by_s2 => config.slip_frames_max,
            GripMode::Incipient => config.incipient_frames,
            _ => 0,
        };
        let least =
            LEAST_FRAMES << if matches!(mode, GripMode::Slip) { self.row.saturating_sub(1) } else { 0 };
        let done = matches!(self.left, Some(0)) && self.elapsed >= least;
        done || self.elapsed >= length || !self.may_close(config, grip)
    }

    /// The last answer has had its time to show in Ft/Fn, and the last ones raised the force.
    pub fn may_tighten(&self, config: &GripConfig, grip: Grip) -> bool {
        let changed = matches!(grip, Grip::Holds(mn) if self.has_changed(mn));
        self.since_incipient >= config.settle_frames && (self.in_vain < IN_VAIN_MAX || changed)
    }

    pub const fn settled(&self, config: &GripConfig) -> bool {
        self.elapsed >= config.settle_frames
    }

    /// A small pulse that raised no force has stalled: the next is stronger by as much.
    pub fn drive(&self, config: &GripConfig, mode: GripMode) -> MotorDrive {
        match mode {
            GripMode::Slip => MotorDrive::Close(Duty::per_mille(config.slip_duty_permille)),
            GripMode::Incipient => {
                // Stall force at this duty of a motor that reaches the ceiling at full duty.
                let stalls_mn = config.ceiling_mn / 1_000 * i32::from(config.incipient_duty_permille);
                let stalled = if self.began_mn.is_some_and(|mn| mn >= stalls_mn) { self.in_vain } else { 0 };
                let stronger = config.incipient_duty_permille.saturating_mul(stalled.saturating_add(1));
                let most = config.slip_duty_permille.max(config.incipient_duty_permille);
                MotorDrive::Close(Duty::per_mille(stronger.min(most)))
            }
            _ => MotorDrive::Coast,
        }
    }
}

#[cfg(test)]
mod edges;
#[cfg(test)]
mod proofs;
#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;

    fn pulse_frames(mode: GripMode, slips: bool, grip: Grip) -> u32 {
        let config = Config::default().grip;
        let mut reflex = Reflex::default();
        reflex.enter(mode, grip);
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
        assert_eq!(pulse_frames(GripMode::Settle, true, Grip::Holds(5_000)), 0);
    }

    fn raised_mn(mode: GripMode, mn_a_frame: i32, lacks_mn: i32) -> i32 {
        let config = Config::default().grip;
        let mut reflex = Reflex::default();
        let mut drives = [0; 60];
        let mut load_mn = 1_000;
        let mut frame = |reflex: &mut Reflex, load_mn: &mut i32, duty: u16, mode: GripMode, aim_mn: i32| {
            drives.rotate_right(1);
            drives[0] = duty;
            *load_mn += i32::from(drives[59]) * mn_a_frame / 1_000;
            reflex.tick(mode, Grip::Holds(*load_mn));
            if duty > 0 {
                reflex.closes(Duty::per_mille(duty), true);
            }
            if reflex.elapsed().is_multiple_of(25) {
                let lacks = Some(aim_mn - *load_mn);
                reflex.feel(mode, Some(*load_mn), Lacks { slip_mn: lacks, warning_mn: lacks, by_s2: true });
            }
        };
        let mut closes_mn = 1_000;
        while closes_mn < 8_000 {
            frame(&mut reflex, &mut load_mn, 500, GripMode::Wearer, 0);
            closes_mn += mn_a_frame / 2;
        }
        (0..400).for_each(|_| frame(&mut reflex, &mut load_mn, 0, GripMode::Watch, 0));
        let before_mn = load_mn;
        (0..50).for_each(|_| frame(&mut reflex, &mut load_mn, 0, GripMode::Watch, before_mn + lacks_mn));
        reflex.enter(mode, Grip::Holds(load_mn));
        while !reflex.pulse_over(&config, mode, true, Grip::Holds(load_mn)) {
            let MotorDrive::Close(duty) = reflex.drive(&config, mode) else { unreachable!() };
            frame(&mut reflex, &mut load_mn, duty.as_per_mille(), mode, before_mn + lacks_mn);
        }
        (0..400).for_each(|_| frame(&mut reflex, &mut load_mn, 0, GripMode::Watch, 0));
        load_mn - before_mn
    }

    // Shows R9.
    #[test]
    fn a_pulse_adds_what_is_lacking_whatever_the_stiffness() {
        for mode in [GripMode::Slip, GripMode::Incipient] {
            for mn_a_frame in [40, 90, 360] {
                for lacks_mn in [800, 1_500] {
                    let added = raised_mn(mode, mn_a_frame, lacks_mn);
                    let least = 6 * mn_a_frame;
                    assert!(
                        (lacks_mn * 4 / 5..=(lacks_mn * 5 / 4).max(least) + mn_a_frame).contains(&added),
                        "{mode:?} {mn_a_frame} {lacks_mn}: {added}"
                    );
                }
            }
        }
        assert!(
            raised_mn(GripMode::Slip, 90, 30_000) <= 9_000,
            "never more than its longest, and than as much again"
        );
        assert!(raised_mn(GripMode::Slip, 360, 30_000) <= 8_000 + 3 * 360);
    }

    #[test]
    fn slip_that_goes_on_is_answered_with_longer_pulses_even_if_nothing_lacks() {
        let config = Config::default().grip;
        let mut reflex = Reflex::default();
        let lengths: [u32; 6] = core::array::from_fn(|_| {
            reflex.enter(GripMode::Slip, Grip::Holds(5_000));
            reflex.left = Some(0);
            while !reflex.pulse_over(&config, GripMode::Slip, true, Grip::Holds(5_000)) {
                reflex.tick(GripMode::Slip, Grip::Holds(5_000));
            }
            let length = reflex.elapsed();
            reflex.enter(GripMode::Watch, Grip::Holds(5_000));
            length
        });
        assert_eq!(lengths, [6, 12, 24, 48, 96, 96]);
    }

    #[test]
    fn a_warning_whose_pulses_raise_nothing_is_answered_no_more_until_the_load_changes() {
        let config = Config::default().grip;
        let mut reflex = Reflex::default();
        for _ in 0..=IN_VAIN_MAX {
            reflex.since_incipient = u32::MAX;
            assert!(reflex.may_tighten(&config, Grip::Holds(5_000)));
            reflex.enter(GripMode::Incipient, Grip::Holds(5_000));
        }
        assert!(!reflex.may_tighten(&config, Grip::Holds(5_010)));
        assert!(reflex.may_tighten(&config, Grip::Holds(5_100)));
        reflex.renew();
        assert!(reflex.may_tighten(&config, Grip::Holds(5_010)));
    }

    #[test]
    fn without_a_force_the_budget_runs_out_until_the_account_is_cleared() {
        let config = Config::default().grip;
        let mut reflex = Reflex::default();
        for _ in 0..config.blind_frames {
            assert!(reflex.may_close(&config, Grip::Unknown));
            reflex.tick(GripMode::Slip, Grip::Unknown);
        }
        assert!(!reflex.may_close(&config, Grip::Unknown));
        reflex.enter(GripMode::Slip, Grip::Unknown);
        assert!(!reflex.may_close(&config, Grip::Unknown) && !reflex.link_may_close(&config, Grip::Unknown));
        reflex.account = Account::default();
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
