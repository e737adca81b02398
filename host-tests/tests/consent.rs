//! What somebody with the cable can do to a hand that does not trust its line: read.

use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{Answer, Down, EventKind, Received, Refusal, Up};
use tenax_hal_shim::words::{Code, Consent, GripMode, Line};
use tenax_host_tests::{Bench, set};
use tenax_logic::config::Config;
use tenax_logic::device::Device;
use tenax_logic::fingertip::Fingertip;
use tenax_logic::setting::SettingId;

const OPEN: Down = Down::Drive { drive: MotorDrive::Open(Duty::FULL), hold_ms: 250 };
const CLOSE: Down = Down::Drive { drive: MotorDrive::Close(Duty::FULL), hold_ms: 250 };
const COAST: Down = Down::Drive { drive: MotorDrive::Coast, hold_ms: 250 };

fn all_that_change() -> Vec<Down> {
    let mut all = vec![
        OPEN,
        CLOSE,
        COAST,
        Down::Begin(Behaviour::Stroke),
        Down::Begin(Behaviour::HandOver),
        Down::End,
        Down::Zero,
        Down::Teach { codes: [Code::Minus, Code::Plus], age_ms: 40 },
        Down::Forget,
        Down::Save,
    ];
    all.extend(SettingId::ALL.map(|id| set(id, id.row().max)));
    all
}

/// A hand of a wearer that holds a glass.
fn strangers(seed: u64) -> Bench {
    let mut bench = Bench::of(Fingertip::default(), seed);
    bench.run(200);
    bench.load(4.0, 0.6);
    bench.run(1_000);
    assert_eq!(bench.fingertip.mode(), GripMode::Watch);
    bench
}

fn press(bench: &mut Bench) {
    bench.fingertip.button(false);
    bench.run(100);
    bench.fingertip.button(true);
    bench.run(100);
    bench.fingertip.button(false);
}

// Shows L1.
#[test]
fn a_stranger_reads_and_changes_nothing() {
    let mut bench = strangers(1);
    let before = *bench.fingertip.config();
    for command in all_that_change() {
        assert_eq!(bench.fingertip.command(&command), Err(Refusal::NotArmed), "{command:?}");
        assert!(bench.run(600).iter().all(|drive| *drive == MotorDrive::Coast));
    }
    for command in [Down::Ping, Down::Samples, Down::Network, Down::Get(1), Down::Settings(0), Down::Hello] {
        assert_eq!(bench.fingertip.command(&command), Ok(()), "{command:?}");
    }
    assert_eq!(*bench.fingertip.config(), before);
    assert_eq!(bench.slows.last().map(|slow| slow.line), Some(Line::Reading));
}

// Shows L2.
#[test]
fn the_button_and_both_muscles_consent_for_a_minute_and_it_is_told() {
    let mut bench = strangers(2);
    press(&mut bench);
    assert_eq!(bench.fingertip.command(&set(SettingId::S1, 120)), Ok(()));
    assert!(matches!(bench.slows.last().map(|slow| slow.line), Some(Line::Armed { left_s: 60 })));
    bench.run(60 * 2_000);
    assert_eq!(bench.fingertip.command(&set(SettingId::S1, 130)), Err(Refusal::NotArmed));

    bench.muscles(500.0, 500.0);
    assert!(bench.run(4_100).iter().all(|drive| *drive == MotorDrive::Coast), "the hand rests meanwhile");
    bench.muscles(40.0, 40.0);
    assert_eq!(bench.fingertip.command(&set(SettingId::S1, 130)), Ok(()));
    let told: Vec<_> = bench.events.iter().map(|event| event.kind).collect();
    assert!(told.contains(&EventKind::Armed(Consent::Button)) && told.contains(&EventKind::Disarmed));
    assert!(told.contains(&EventKind::Armed(Consent::Muscles)));
}

// Shows L2.
#[test]
fn an_empty_hand_just_switched_on_consents_but_not_to_trust_for_ever() {
    let mut bench = Bench::of(Fingertip::default(), 3);
    bench.run(200);
    let trust = set(SettingId::LineTrusted, 1);
    assert_eq!(bench.fingertip.command(&set(SettingId::S1, 120)), Ok(()));
    assert_eq!(bench.fingertip.command(&trust), Err(Refusal::NotArmed));
    bench.load(4.0, 0.6);
    bench.run(100);
    assert_eq!(
        bench.fingertip.command(&set(SettingId::S1, 130)),
        Err(Refusal::NotArmed),
        "it holds something"
    );
    press(&mut bench);
    assert_eq!(bench.fingertip.command(&trust), Ok(()));
    bench.run(61 * 2_000);
    assert_eq!(bench.fingertip.command(&set(SettingId::S1, 1_500)), Ok(()), "trusted");
    assert_eq!(bench.fingertip.command(&set(SettingId::LineTrusted, 0)), Ok(()));
    assert_eq!(bench.fingertip.command(&set(SettingId::S1, 120)), Err(Refusal::NotArmed));
    assert_eq!(bench.fingertip.config().get(SettingId::S1), 1_500, "what was set stays");
}

// Shows L2.
#[test]
fn a_restart_by_the_watchdog_is_no_consent() {
    let mut bench = Bench::of(Fingertip::default(), 4);
    bench.fingertip.was_reset();
    bench.run(400);
    assert_eq!(bench.fingertip.command(&OPEN), Err(Refusal::NotArmed));
}

// Shows W2.
#[test]
fn a_links_open_never_beats_an_active_flexor() {
    for flexor_mv in [200.0, 600.0] {
        let mut bench = Bench::holding(5);
        assert_eq!(bench.fingertip.command(&OPEN), Ok(()));
        assert!(bench.run(20).iter().any(|drive| drive.opens()), "the control: nobody else wants anything");
        bench.muscles(flexor_mv, 40.0);
        bench.run(30);
        assert!(bench.run(300).iter().all(|drive| !drive.opens()), "{flexor_mv} mV");
        assert_eq!(bench.fingertip.command(&OPEN), Err(Refusal::WearerActive));
    }
}

// Shows L3.
#[test]
fn a_links_close_ends_at_the_force_ceiling() {
    let mut bench = Bench::holding(6);
    bench.fingertip.command(&set(SettingId::ForceCeiling, 5_000)).unwrap();
    bench.fingertip.command(&CLOSE).unwrap();
    assert!(bench.run(100).iter().any(|drive| drive.closes()), "4 N are held, 5 N are allowed");
    bench.load(5.5, 0.8);
    bench.run(30);
    for _ in 0..20 {
        bench.fingertip.command(&CLOSE).unwrap();
        assert!(bench.run(400).iter().all(|drive| *drive == MotorDrive::Coast));
    }
}

// Shows R3.
#[test]
fn a_link_that_cannot_feel_spends_the_blind_budget_and_does_not_renew_it() {
    let mut bench = Bench::holding(7);
    bench.pins_mv[tenax_hal_shim::channel::FSR + 1] = 0.0;
    bench.run(200);
    bench.vibration_mv = 800.0;
    let mut closing = 0;
    for _ in 0..400 {
        let _ = bench.fingertip.command(&Down::Drive { drive: MotorDrive::Close(Duty::FULL), hold_ms: 5 });
        closing += bench.run(100).iter().filter(|drive| drive.closes()).count();
    }
    let budget = bench.fingertip.config().grip.blind_frames as usize;
    assert!(
        (budget..=budget + 1).contains(&closing),
        "{closing} frames of closing in 20 s, {budget} allowed"
    );
    bench.muscles(400.0, 40.0);
    bench.run(100);
    bench.muscles(40.0, 40.0);
    assert!(bench.run(2_000).iter().any(|drive| drive.closes()), "a muscle renews it");
}

// Shows L4.
#[test]
fn to_coast_silences_no_reflex() {
    let mut bench = Bench::holding(8);
    bench.vibration_mv = 800.0;
    for _ in 0..40 {
        bench.fingertip.command(&COAST).unwrap();
        bench.run(200);
    }
    assert!(bench.by_reflex() > 500, "{}", bench.by_reflex());
}

/// As slowly as the motor is quieter than slip; a hand that is held where it is, or closes faster, does not listen.
// Shows R1, L4.
#[test]
fn a_line_that_closes_slowly_silences_no_reflex() {
    let by_reflex = |duty: u16, muscle_mv: f64| {
        let mut bench = Bench::holding(8);
        bench.muscles(muscle_mv, 40.0);
        bench.run(600);
        bench.slows.clear();
        bench.vibration_mv = 800.0;
        for _ in 0..40 {
            let close = Down::Drive { drive: MotorDrive::Close(Duty::per_mille(duty)), hold_ms: 100 };
            let _ = bench.fingertip.command(&close);
            bench.run(200);
        }
        bench.by_reflex()
    };
    let loud = Config::default().hebbian.loud_duty_permille;
    assert!(by_reflex(1, 40.0) > 500 && by_reflex(loud - 1, 40.0) > 500);
    for (duty, muscle_mv) in [(0, 40.0), (loud, 40.0), (1_000, 40.0), (1, 400.0)] {
        assert_eq!(by_reflex(duty, muscle_mv), 0, "{duty} per mille, {muscle_mv} mV");
    }
}

/// By consent, of an untrusted line: a gripper's may hold for as long as it likes.
// Shows L4.
#[test]
fn a_link_that_holds_for_ever_gives_the_reflex_back() {
    let mut bench = strangers(9);
    press(&mut bench);
    bench.vibration_mv = 800.0;
    bench.slows.clear();
    let mut refused = 0;
    for _ in 0..130 {
        let hold = Down::Drive { drive: MotorDrive::Open(Duty::per_mille(100)), hold_ms: 100 };
        refused += u32::from(bench.fingertip.command(&hold) == Err(Refusal::HeldTooLong));
        bench.run(200);
    }
    assert!(refused > 20 && bench.by_reflex() > 500, "{refused}, {}", bench.by_reflex());
}

fn answer(device: &mut Device, sequence: u16, message: Down) -> Answer {
    match device.command(&Received { sequence, message }) {
        Up::Answer { of, answer, .. } if of == sequence => answer,
        other => panic!("{other:?}"),
    }
}

// Shows L5.
#[test]
fn a_recorded_session_does_nothing_when_it_is_sent_again() {
    let mut bench = strangers(10);
    press(&mut bench);
    let mut device = Device::new(bench.fingertip.clone());
    assert_eq!(answer(&mut device, 0, COAST), Answer::Refused(Refusal::NoSession));
    let Answer::Nonce(nonce) = answer(&mut device, 1, Down::Hello) else { panic!("no number") };
    let session = [(2, Down::Open { nonce }), (3, CLOSE), (4, COAST)];
    for (sequence, message) in session {
        assert_eq!(answer(&mut device, sequence, message), Answer::Done);
    }
    for (sequence, message) in session {
        assert_eq!(answer(&mut device, sequence, message), Answer::Refused(Refusal::Replayed));
    }
    assert_eq!(answer(&mut device, 5 + 1_024, COAST), Answer::Refused(Refusal::Replayed), "too far ahead");
    assert_eq!(answer(&mut device, 4 + 1_024, COAST), Answer::Done);
}
