//! Each condition of the reflex on both sides of its boundary.

use super::*;
use crate::config::Config;

fn config() -> GripConfig {
    Config::default().grip
}

#[test]
fn a_bound_reflex_spends_its_budget_whatever_is_felt_and_the_line_does_not() {
    let config = config();
    let holds = Grip::Holds(5_000);
    let mut reflex = Reflex {
        account: Account { blind: config.blind_frames - 1, ..Account::default() },
        ..Reflex::default()
    };
    reflex.bind(true);
    assert!(reflex.may_close(&config, holds));
    reflex.tick(GripMode::Slip, holds, false);
    assert!(!reflex.may_close(&config, holds), "it is spent");
    assert!(reflex.link_may_close(&config, Grip::Holds(config.ceiling_mn - 1)));
    reflex.bind(false);
    assert!(reflex.may_close(&config, holds));
    assert!(!reflex.may_close(&config, Grip::Holds(config.ceiling_mn)));
    reflex.tick(GripMode::Slip, holds, false);
    assert_eq!(reflex.account.blind, config.blind_frames, "a force that is felt spends nothing");
}

#[test]
fn a_load_has_changed_beyond_the_sensors_noise() {
    let began = Reflex { began_mn: Some(20_000), ..Reflex::default() };
    assert_eq!([19_899, 19_900, 20_100, 20_101].map(|mn| began.has_changed(mn)), [true, false, false, true]);
    assert!(Reflex::default().has_changed(0), "nobody knows");
}

fn loads(load_mn: i32) -> Forces {
    Forces {
        fn_mn: load_mn,
        fx_mn: 1_000,
        fy_mn: 0,
        ft_mn: 1_000,
        load_mn,
        ratio_permille: Some((1_000_000 / load_mn) as u16),
    }
}

fn relaxing() -> Reflex {
    let mut reflex = Reflex::default();
    reflex.feel(GripMode::Watch, Some(&loads(3_000)), Lacks::default());
    reflex.relax(GripMode::Watch, Some(&held(3_000)));
    for n in 0..8 {
        (0..25).for_each(|_| reflex.closes(Duty::FULL, true));
        reflex.feel(GripMode::Slip, Some(&loads(3_000 + 1_250 * (n - 2).max(0))), Lacks::default());
    }
    (0..10).for_each(|_| reflex.feel(GripMode::Watch, Some(&loads(16_000)), Lacks::default()));
    for _ in 0..10_000 {
        reflex.relax(GripMode::Watch, Some(&held(16_000)));
        if reflex.is_relaxing() {
            return reflex;
        }
    }
    unreachable!("it never relaxes")
}

fn held(load_mn: i32) -> relax::Reading {
    relax::Reading { load_mn, ft_mn: 1_000, slid_permille: Some(500) }
}

#[test]
fn it_relaxes_while_it_watches_and_a_word_or_somebody_else_ends_it() {
    let reflex = relaxing();
    assert!(matches!({ reflex }.relaxes(), MotorDrive::Open(_)));
    assert_eq!(Reflex::default().relaxes(), MotorDrive::Coast);
    let is_on = |change: &dyn Fn(&mut Reflex)| {
        let mut reflex = reflex;
        change(&mut reflex);
        reflex.is_relaxing()
    };
    assert!(is_on(&|_| {}));
    assert!(!is_on(&|reflex| reflex.hear(true, Heard::default())));
    assert!(!is_on(&|reflex| reflex.closes(Duty::FULL, true)));
    assert!(!is_on(&|reflex| reflex.closes(Duty::FULL, false)));
    for mode in [GripMode::Slip, GripMode::Incipient, GripMode::Settle] {
        assert!(is_on(&|reflex| reflex.relax(mode, Some(&held(16_000)))), "{mode:?}: stands");
    }
    for mode in [GripMode::Wearer, GripMode::Standby] {
        assert!(!is_on(&|reflex| reflex.relax(mode, Some(&held(16_000)))), "{mode:?}");
    }
    assert!(!is_on(&|reflex| reflex.relax(GripMode::Watch, None)));
}

#[test]
fn a_warnings_pulse_and_pause_have_their_lengths() {
    let config = config();
    let holds = Grip::Holds(5_000);
    let over = |left, by_s2, elapsed| {
        let lacks = Lacks { by_s2, ..Lacks::default() };
        let reflex = Reflex { left, lacks, elapsed, ..Reflex::default() };
        reflex.pulse_over(&config, GripMode::Incipient, false, holds)
    };
    // Only a pulse of which S2 says how much is lacking may last as long as one for slip.
    for (left, by_s2, frames) in [
        (Some(1), true, config.slip_frames_max),
        (Some(1), false, config.incipient_frames),
        (None, true, config.incipient_frames),
        (None, false, config.incipient_frames),
    ] {
        assert_eq!([frames - 1, frames].map(|elapsed| over(left, by_s2, elapsed)), [false, true]);
    }
    let settled = |still| Reflex { still, ..Reflex::default() }.settled(&config);
    assert_eq!([config.settle_frames - 1, config.settle_frames].map(settled), [false, true]);

    let mut reflex = Reflex::default();
    reflex.tick(GripMode::Watch, holds, false);
    assert!(reflex.may_tighten(&config, holds), "nothing was answered yet");
    reflex.tick(GripMode::Incipient, holds, false);
    (1..config.settle_frames).for_each(|_| _ = reflex.tick(GripMode::Watch, holds, false));
    assert!(!reflex.may_tighten(&config, holds));
    reflex.tick(GripMode::Watch, holds, false);
    assert!(reflex.may_tighten(&config, holds));
}

#[test]
fn a_pulse_that_stalled_is_stronger_only_above_the_load_that_its_duty_stalls_at() {
    let config = config();
    let stalls_mn = config.ceiling_mn * i32::from(config.incipient_duty_permille) / 1_000;
    let duty = |began_mn, in_vain| {
        let reflex = Reflex { began_mn, in_vain, ..Reflex::default() };
        let MotorDrive::Close(duty) = reflex.drive(&config, GripMode::Incipient) else { unreachable!() };
        duty.as_per_mille()
    };
    let own = config.incipient_duty_permille;
    assert_eq!([Some(stalls_mn - 1), None].map(|began| duty(began, 1)), [own; 2]);
    assert_eq!(
        [0, 1, 8].map(|in_vain| duty(Some(stalls_mn), in_vain)),
        [own, 2 * own, config.slip_duty_permille]
    );
}
