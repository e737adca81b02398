//! The grip reflex: how much to close on slip or incipient slip.
//!
//! Closing ends when the target of a [`Slide`], or the force that a warning lacks ([`Lacks`]), is there: by the
//! measured force plus the travel that it does not show yet times the stiffness ([`Stiffness`]). Where that is
//! unknown, a pulse has the set length. After slip the object settles for longer than the motor's dead time. No pulse begins on a
//! finger that holds nothing or is at the force ceiling; while the force is unknown, all pulses share the blind
//! budget of the [`Account`].

pub mod relax;
pub mod settings;
pub mod slide;
mod stiffness;

use tenax_hal_shim::channel::frames;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::Forces;
use tenax_hal_shim::words::GripMode;

use self::relax::Relax;
use self::settings::GripConfig;
use self::slide::{Carried, Heard, Slide};
use self::stiffness::Stiffness;
use crate::account::Account;
use crate::force::friction::Lacks;

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

/// Time after which the films no longer hear the motor, 100 ms.
const STILL_FRAMES: u32 = frames(100);
/// Shortest pulse against a warning: 3 ms.
const LEAST_FRAMES: u32 = 6;

#[derive(Clone, Copy, Debug)]
pub struct Reflex {
    elapsed: u32,
    /// Frames since the motor was loud, saturating.
    still: u32,
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
    /// Slide that is answered while the force is known; kept after it, until the hand lets go.
    slide: Option<Slide>,
    /// Ratio that the last slide of this grasp showed, per mille.
    slid_permille: Option<u16>,
    heard: Heard,
    /// How sure a slip is that is reported now, per mille.
    pub sure_permille: i32,
    slide_over: bool,
    /// A report that Ft has refuted stands.
    refuted: bool,
    /// Fn before the first answer to a quiet slip in this grasp, mN.
    quiet_from_mn: Option<i32>,
}

impl Default for Reflex {
    fn default() -> Self {
        Self {
            elapsed: 0,
            still: 0,
            since_incipient: u32::MAX,
            account: Account::default(),
            bound: false,
            began_mn: None,
            in_vain: 0,
            stiffness: Stiffness::default(),
            relax: Relax::default(),
            lacks: Lacks::default(),
            left: None,
            slide: None,
            slid_permille: None,
            heard: Heard::default(),
            sure_permille: 1_000,
            slide_over: false,
            refuted: false,
            quiet_from_mn: None,
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
    pub fn enter(&mut self, mode: GripMode, grip: Grip, known: Option<(&Forces, Carried)>) {
        match mode {
            GripMode::Slip => {
                let fn_mn = known.map_or(0, |(forces, _)| forces.fn_mn);
                if self.heard.quiet && known.is_some() {
                    self.quiet_from_mn.get_or_insert(fn_mn);
                }
                let most_mn = self.most_quiet_mn().unwrap_or(fn_mn);
                self.slide = known.map(|(forces, carried)| {
                    Slide::begin(forces, carried, self.heard, self.sure_permille, most_mn)
                });
            }
            GripMode::Settle if self.left.is_some() => {}
            _ => self.slide = None,
        }
        self.elapsed = 0;
        if crate::mode::closes(mode)
            && let Grip::Holds(mn) = grip
        {
            self.in_vain = if self.has_changed(mn) { 0 } else { self.in_vain.saturating_add(1) };
            self.began_mn = Some(mn);
        }
        match (mode, known) {
            (GripMode::Slip, Some((forces, _))) => {
                self.slide_over = false;
                let lacks_mn = self.slide.map(|slide| slide.lacks_mn(forces));
                self.left = lacks_mn.and_then(|lacks_mn| self.stiffness.travel_for(lacks_mn));
            }
            _ => self.size(mode),
        }
    }

    fn has_changed(&self, load_mn: i32) -> bool {
        self.began_mn.is_none_or(|began| (load_mn - began).abs() > began / RAISES_PART)
    }

    /// Call it once a slow frame. `forces` None: unknown, or nothing is held.
    #[inline(never)]
    pub fn feel(&mut self, mode: GripMode, forces: Option<&Forces>, lacks: Lacks) {
        self.stiffness.feel(forces.map(|forces| forces.load_mn));
        if forces.is_none() {
            (self.began_mn, self.in_vain, self.slid_permille) = (None, 0, None);
            self.quiet_from_mn = None;
        }
        self.lacks = lacks;
        match mode {
            GripMode::Slip if self.slide.is_some() => self.size_slide(forces),
            _ => self.size(mode),
        }
    }

    fn size_slide(&mut self, forces: Option<&Forces>) {
        let Some(slide) = &mut self.slide else { return };
        let lacks_mn = forces.and_then(|forces| slide.feel(forces, self.heard, self.sure_permille));
        self.slid_permille = slide.slid_permille().or(self.slid_permille);
        match lacks_mn {
            Some(..=0) => self.left = Some(0),
            Some(lacks_mn) => self.left = self.stiffness.travel_for(lacks_mn),
            // What was known of the force no longer holds: the rest of the answer is a pulse of the set length.
            None => (self.slide, self.left) = (None, None),
        }
    }

    /// Ratio at which the object slid in this grasp, per mille.
    pub const fn slid_permille(&self) -> Option<u16> {
        self.slid_permille
    }

    #[inline(never)]
    fn size(&mut self, mode: GripMode) {
        let lacks_mn = if mode == GripMode::Incipient { self.lacks.warning_mn } else { None };
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

    /// Reports of this frame.
    pub fn hear(&mut self, any: bool, heard: Heard) {
        self.heard = heard;
        self.refuted &= heard.slip();
        if heard.loud {
            self.quiet_from_mn = None;
        }
        if any {
            self.relax.hear();
        }
    }

    pub fn relaxes(&mut self) -> MotorDrive {
        match self.relax.opens() {
            0 => MotorDrive::Coast,
            duty => MotorDrive::Open(Duty::per_mille(duty)),
        }
    }

    /// A muscle is active: warnings that were in vain are answered anew.
    pub const fn renew(&mut self) {
        (self.began_mn, self.in_vain, self.quiet_from_mn) = (None, 0, None);
    }

    pub fn spend(&mut self, grip: Grip) {
        if grip == Grip::Unknown {
            self.account.blind = self.account.blind.saturating_add(1);
        }
    }

    pub const fn elapsed(&self) -> u32 {
        self.elapsed
    }

    /// True: a report has been refuted.
    pub fn tick(&mut self, mode: GripMode, grip: Grip, motor_is_loud: bool) -> bool {
        self.still = if motor_is_loud { 0 } else { self.still.saturating_add(1) };
        self.elapsed = self.elapsed.saturating_add(1);
        let was_refuted = self.refuted;
        if mode == GripMode::Slip
            && let Some(slide) = &mut self.slide
        {
            self.slide_over = slide.tick(self.left != Some(0), self.heard);
            self.refuted |= slide.is_refuted();
        }
        self.since_incipient = self.since_incipient.saturating_add(1);
        if mode == GripMode::Incipient {
            self.since_incipient = 0;
        }
        if crate::mode::closes(mode) {
            self.spend(if self.bound { Grip::Unknown } else { grip });
        }
        self.refuted && !was_refuted
    }

    pub fn pulse_over(&self, config: &GripConfig, mode: GripMode, slips: bool, grip: Grip) -> bool {
        if matches!(mode, GripMode::Slip) && self.slide.is_some() && self.left.is_some() {
            return self.slide_over || !self.may_close(config, grip);
        }
        let length = match mode {
            GripMode::Slip if self.slide.is_some_and(|slide| slide.is_quiet()) => config.incipient_frames,
            GripMode::Slip if slips => config.slip_frames_max,
            GripMode::Slip => config.slip_frames,
            GripMode::Incipient if self.left.is_some() && self.lacks.by_s2 => config.slip_frames_max,
            GripMode::Incipient => config.incipient_frames,
            _ => 0,
        };
        let done = matches!(self.left, Some(0)) && self.elapsed >= LEAST_FRAMES;
        done || self.elapsed >= length || !self.may_close(config, grip)
    }

    /// A report of slip is answered anew once it has been silent since it was refuted.
    pub fn may_answer(&self, grip: Grip) -> bool {
        let Heard { loud, felt, .. } = self.heard;
        let spent = match (grip, self.most_quiet_mn()) {
            (Grip::Holds(mn), Some(most_mn)) => mn >= most_mn,
            _ => false,
        };
        !self.refuted && (loud || felt || !spent)
    }

    /// Force that quiet slips may add in one grasp: half as much again.
    fn most_quiet_mn(&self) -> Option<i32> {
        self.quiet_from_mn.map(|from_mn| from_mn + from_mn / 2)
    }

    pub const fn is_still(&self) -> bool {
        self.still > STILL_FRAMES
    }

    /// The last answer has had its time to show in Ft/Fn, and the last ones raised the force.
    pub fn may_tighten(&self, config: &GripConfig, grip: Grip) -> bool {
        let changed = matches!(grip, Grip::Holds(mn) if self.has_changed(mn));
        self.since_incipient >= config.settle_frames && (self.in_vain < IN_VAIN_MAX || changed)
    }

    /// After a slide whose target was reached the vibration alone begins another.
    pub fn settled(&self, config: &GripConfig) -> bool {
        self.elapsed.max(self.still) >= config.settle_frames || (self.slide.is_some() && self.heard.loud)
    }

    /// A small pulse that raised no force has stalled: the next is stronger by as much.
    pub fn drive(&self, config: &GripConfig, mode: GripMode) -> MotorDrive {
        match mode {
            GripMode::Slip if self.slide.is_some() && matches!(self.left, Some(0)) => MotorDrive::Coast,
            // Slowly where nothing tells how much a quiet slip's answer adds.
            GripMode::Slip if self.left.is_none() && self.slide.is_some_and(|slide| slide.is_quiet()) => {
                MotorDrive::Close(Duty::per_mille(config.incipient_duty_permille))
            }
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
        reflex.enter(mode, grip, None);
        (0..10_000)
            .take_while(|_| {
                let over = reflex.pulse_over(&config, mode, slips, grip);
                reflex.tick(mode, grip, false);
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

    /// An object of which a finger carries `load_mn`, held with 8 N; friction falls to `mu_permille` at the begin.
    struct Held {
        load_mn: i32,
        mu_permille: i32,
        mn_a_frame: i32,
        dead_frames: usize,
    }

    impl Held {
        /// Fn before and after an answer in this mode, mN.
        fn answered(&self, mode: GripMode, heard: Heard) -> (i32, i32) {
            let config = Config::default().grip;
            let (mut reflex, mut fn_mn, mut drives) = (Reflex::default(), 1_000, [0; 300]);
            let aim_mn = core::cell::Cell::new(0);
            let mut frame =
                |reflex: &mut Reflex, fn_mn: &mut i32, duty: u16, mode: GripMode, mu_permille: i32| {
                    drives.rotate_right(1);
                    drives[0] = duty;
                    *fn_mn += i32::from(drives[self.dead_frames]) * self.mn_a_frame / 1_000;
                    let ft_mn = self.load_mn.min(*fn_mn * mu_permille / 1_000);
                    let ratio_permille = Some((ft_mn * 1_000 / *fn_mn) as u16);
                    let forces =
                        Forces { fn_mn: *fn_mn, fx_mn: 0, fy_mn: 0, ft_mn, load_mn: *fn_mn, ratio_permille };
                    let slides = ft_mn < self.load_mn;
                    reflex.hear(false, if slides || mu_permille == 2_000 { heard } else { Heard::default() });
                    reflex.tick(mode, Grip::Holds(*fn_mn), false);
                    if duty > 0 {
                        reflex.closes(Duty::per_mille(duty), true);
                    }
                    if reflex.elapsed().is_multiple_of(25) {
                        let lacks = Lacks { warning_mn: Some(aim_mn.get() - *fn_mn), by_s2: true };
                        reflex.feel(mode, Some(&forces), lacks);
                    }
                    forces
                };
            while fn_mn < 8_000 {
                frame(&mut reflex, &mut fn_mn, 500, GripMode::Wearer, 1_000);
            }
            (0..400).for_each(|_| _ = frame(&mut reflex, &mut fn_mn, 0, GripMode::Watch, 1_000));
            let before_mn = fn_mn;
            aim_mn.set(before_mn + WARNED_MN);
            (0..25).for_each(|_| _ = frame(&mut reflex, &mut fn_mn, 0, GripMode::Watch, 1_000));
            let forces = frame(&mut reflex, &mut fn_mn, 0, GripMode::Watch, self.mu_permille);
            reflex.hear(true, heard);
            reflex.enter(
                mode,
                Grip::Holds(fn_mn),
                Some((&forces, Carried { ft_mn: self.load_mn, grown_mn: 0 })),
            );
            for _ in 0..4_000 {
                if reflex.pulse_over(&config, mode, false, Grip::Holds(fn_mn)) {
                    break;
                }
                let duty = match reflex.drive(&config, mode) {
                    MotorDrive::Close(duty) => duty.as_per_mille(),
                    _ => 0,
                };
                frame(&mut reflex, &mut fn_mn, duty, mode, self.mu_permille);
            }
            (0..400).for_each(|_| _ = frame(&mut reflex, &mut fn_mn, 0, GripMode::Watch, self.mu_permille));
            (before_mn, fn_mn)
        }
    }

    const WARNED_MN: i32 = 1_200;
    const LOUD: Heard = Heard { loud: true, quiet: false, felt: false };

    // Shows R9.
    #[test]
    fn a_slide_ends_near_what_friction_needs_whatever_the_stiffness_and_the_dead_time() {
        for mn_a_frame in [20, 60, 120] {
            for dead_frames in [20, 60, 120] {
                for (load_mn, mu_permille) in [(2_500, 200), (3_000, 300), (2_000, 220)] {
                    let held = Held { load_mn, mu_permille, mn_a_frame, dead_frames };
                    let (before_mn, after_mn) = held.answered(GripMode::Slip, LOUD);
                    let needed_mn = load_mn * 1_000 / mu_permille;
                    let in_flight_mn = mn_a_frame * (dead_frames as i32 + 50);
                    assert!(
                        (needed_mn..=needed_mn * 3 / 2 + in_flight_mn).contains(&after_mn),
                        "{mn_a_frame} {dead_frames} {load_mn} {mu_permille}: {before_mn} > {after_mn}, {needed_mn} is needed"
                    );
                }
            }
        }
    }

    #[test]
    fn what_does_not_follow_is_refuted_before_the_first_target() {
        for mn_a_frame in [20, 60] {
            // Nothing slides, however loud it is.
            let held = Held { load_mn: 2_500, mu_permille: 2_000, mn_a_frame, dead_frames: 60 };
            let (before_mn, after_mn) = held.answered(GripMode::Slip, LOUD);
            let first_mn = before_mn * 2;
            assert!(after_mn < first_mn, "{mn_a_frame}: {before_mn} > {after_mn}");
            let (_, probed_mn) = held.answered(GripMode::Slip, Heard { loud: false, felt: true, ..LOUD });
            assert!(probed_mn <= after_mn && probed_mn < before_mn * 3 / 2, "{mn_a_frame}: {probed_mn}");
        }
    }

    #[test]
    fn a_warning_adds_what_is_lacking_whatever_the_stiffness() {
        for mn_a_frame in [40, 90, 360] {
            let held = Held { load_mn: 2_500, mu_permille: 1_000, mn_a_frame, dead_frames: 60 };
            let (before_mn, after_mn) = held.answered(GripMode::Incipient, Heard::default());
            let added = after_mn - before_mn;
            let most = (WARNED_MN * 5 / 4).max(6 * mn_a_frame) + mn_a_frame;
            assert!((WARNED_MN * 4 / 5..=most).contains(&added), "{mn_a_frame}: {added}");
        }
    }

    #[test]
    fn a_warning_whose_pulses_raise_nothing_is_answered_no_more_until_the_load_changes() {
        let config = Config::default().grip;
        let mut reflex = Reflex::default();
        for _ in 0..=IN_VAIN_MAX {
            reflex.since_incipient = u32::MAX;
            assert!(reflex.may_tighten(&config, Grip::Holds(5_000)));
            reflex.enter(GripMode::Incipient, Grip::Holds(5_000), None);
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
            reflex.tick(GripMode::Slip, Grip::Unknown, false);
        }
        assert!(!reflex.may_close(&config, Grip::Unknown));
        reflex.enter(GripMode::Slip, Grip::Unknown, None);
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
