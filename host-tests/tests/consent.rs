//! A hand that does not trust its line: without consent of the wearer, the line may only read.

use proptest::prelude::*;
use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{Down, EventKind, Refusal, Setting};
use tenax_hal_shim::words::{Code, Consent, GripMode, Line};
use tenax_host_tests::{Bench, closes, opens, rests, set};
use tenax_logic::config::Config;
use tenax_logic::fingertip::Fingertip;
use tenax_logic::setting::SettingId;

const OPEN: Down = Down::Drive { drive: MotorDrive::Open(Duty::FULL), hold_ms: 250 };
const CLOSE: Down = Down::Drive { drive: MotorDrive::Close(Duty::FULL), hold_ms: 250 };
const COAST: Down = Down::Drive { drive: MotorDrive::Coast, hold_ms: 250 };

fn distrustful(seed: u64) -> Bench {
    let mut bench = Bench::of(Fingertip::default(), seed);
    bench.run(200);
    bench.load(4.0, 0.6);
    bench.run(1_000);
    assert_eq!(bench.fingertip.mode(), GripMode::Watch);
    bench
}

fn refuses(bench: &mut Bench, command: Down) {
    assert_eq!(bench.fingertip.command(&command), Err(Refusal::NotArmed), "{command:?}");
}

// Shows L1.
#[test]
fn a_stranger_reads_and_changes_nothing() {
    let mut bench = distrustful(1);
    let before = *bench.fingertip.config();
    let changes = [
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
        Down::SetOf { of: 1, n: 0, count: 1, setting: Setting { id: SettingId::S1.number(), value: 120 } },
    ];
    for command in changes.into_iter().chain(SettingId::ALL.map(|id| set(id, id.row().max))) {
        refuses(&mut bench, command);
        assert!(rests(&bench.run(600)));
    }
    for command in [Down::Ping, Down::Samples, Down::Network, Down::Get(1), Down::Settings(0), Down::Hello] {
        bench.accepts(command);
    }
    assert_eq!(*bench.fingertip.config(), before);
    assert_eq!(bench.slows.last().map(|slow| slow.line), Some(Line::Reading));
}

// Shows L2.
#[test]
fn the_button_and_both_muscles_consent_for_a_minute_and_it_is_told() {
    let mut bench = distrustful(2);
    bench.press_button(100);
    bench.accepts(set(SettingId::S1, 120));
    assert!(matches!(bench.slows.last().map(|slow| slow.line), Some(Line::Armed { left_s: 60 })));
    bench.run(60 * 2_000);
    refuses(&mut bench, set(SettingId::S1, 130));

    bench.muscles(500.0, 500.0);
    assert!(rests(&bench.run(4_100)), "the hand rests meanwhile");
    bench.muscles(40.0, 40.0);
    bench.accepts(set(SettingId::S1, 130));
    for told in [EventKind::Armed(Consent::Button), EventKind::Disarmed, EventKind::Armed(Consent::Muscles)] {
        assert!(bench.count(told) > 0, "{told:?}");
    }
}

// Shows L2, R8.
#[test]
fn an_empty_hand_just_switched_on_consents_but_not_to_lasting_trust_or_to_no_wearer() {
    let mut bench = Bench::of(Fingertip::default(), 3);
    bench.run(200);
    bench.accepts(set(SettingId::S1, 120));
    bench.accepts(COAST);
    refuses(&mut bench, set(SettingId::LineTrusted, 1));
    refuses(&mut bench, set(SettingId::NoWearer, 1));
    bench.load(4.0, 0.6);
    bench.run(100);
    refuses(&mut bench, set(SettingId::S1, 130));
    bench.press_button(100);
    for none in [true, false] {
        bench.accepts(set(SettingId::NoWearer, none.into()));
        bench.run(100);
        assert_eq!(bench.count(EventKind::NoWearer(none)), 1);
    }
    bench.accepts(set(SettingId::LineTrusted, 1));
    bench.run(61 * 2_000);
    bench.accepts(set(SettingId::S1, 1_500));
    bench.accepts(set(SettingId::LineTrusted, 0));
    refuses(&mut bench, set(SettingId::S1, 120));
    assert_eq!(bench.fingertip.config().get(SettingId::S1), 1_500, "what was set stays");
}

// Shows W2.
#[test]
fn an_opening_by_the_line_never_beats_an_active_flexor() {
    for flexor_mv in [200.0, 600.0] {
        let mut bench = Bench::holding(5);
        bench.accepts(OPEN);
        assert!(opens(&bench.run(20)), "the control");
        bench.muscles(flexor_mv, 40.0);
        bench.run(30);
        assert!(!opens(&bench.run(300)), "{flexor_mv} mV");
        assert_eq!(bench.fingertip.command(&OPEN), Err(Refusal::WearerActive));
    }
}

// Shows L3.
#[test]
fn a_closing_by_the_line_ends_at_the_force_ceiling() {
    let mut bench = Bench::holding(6);
    bench.accepts(set(SettingId::ForceCeiling, 5_000));
    bench.accepts(CLOSE);
    assert!(closes(&bench.run(100)), "4 N are held, 5 N are allowed");
    bench.load(5.5, 0.8);
    bench.run(30);
    for _ in 0..20 {
        bench.accepts(CLOSE);
        assert!(rests(&bench.run(400)));
    }
}

/// A line that closes more slowly than the motor is loud lets the reflex listen; one that holds the hand, or closes faster, does not.
// Shows R1, L4.
#[test]
fn a_line_that_coasts_or_closes_slowly_silences_no_reflex() {
    let by_reflex = |drive: MotorDrive, muscle_mv: f64| {
        let mut bench = Bench::holding(8);
        bench.muscles(muscle_mv, 40.0);
        bench.run(600);
        bench.slows.clear();
        for n in 0..40 {
            bench.vibration_mv = if n % 4 < 2 { 800.0 } else { 0.0 };
            let _ = bench.fingertip.command(&Down::Drive { drive, hold_ms: 100 });
            bench.run(200);
        }
        bench.by_reflex()
    };
    let close = |permille| MotorDrive::Close(Duty::per_mille(permille));
    let loud = Config::default().hebbian.loud_duty_permille;
    for drive in [MotorDrive::Coast, close(1), close(loud - 1)] {
        assert!(by_reflex(drive, 40.0) > 500, "{drive:?}");
    }
    for (permille, muscle_mv) in [(0, 40.0), (loud, 40.0), (1_000, 40.0), (1, 400.0)] {
        assert_eq!(by_reflex(close(permille), muscle_mv), 0, "{permille} per mille, {muscle_mv} mV");
    }
}

const IDS: [SettingId; 3] = [SettingId::S1, SettingId::S2, SettingId::Loaded];

proptest! {
    /// Two clients' frames, mixed, lost and repeated. A value out of range is in the second one's.
    #[test]
    fn a_transaction_sets_all_or_nothing(frames in prop::collection::vec((0..2_u16, 0..3_u8), 0..60), bad in 0..4_u8) {
        let mut fingertip = Fingertip::trusting();
        let value = |of: u16, n: u8| if (of, n) == (1, bad) { -1 } else { 400 + 100 * i32::from(of) };
        let now = |fingertip: &Fingertip| IDS.map(|id| fingertip.config().get(id));
        let before = now(&fingertip);
        // In order at the end, so that each is taken if it can be.
        for (of, n) in frames.into_iter().chain([(1, 0), (1, 1), (1, 2), (0, 0), (0, 1), (0, 2)]) {
            let setting = Setting { id: IDS[usize::from(n)].number(), value: value(of, n) };
            let done = fingertip.command(&Down::SetOf { of, n, count: 3, setting });
            let is_set = now(&fingertip) == [0, 1, 2].map(|n| value(of, n));
            let is_whole = is_set || [before, [400; 3], [500; 3]].contains(&now(&fingertip));
            prop_assert!(is_whole && (is_set || n < 2 || done.is_err()), "{:?}", done);
            prop_assert!((of, n) != (1, bad) || done.is_err());
        }
        prop_assert_eq!(now(&fingertip), [400; 3]);
    }
}
