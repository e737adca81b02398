//! A gripper that nobody wears: its reflex works without myosensors once a person at the hand has said so.

use tenax_hal_shim::channel::{MYO_EXTENSOR, MYO_FLEXOR};
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{GripMode, Kept};
use tenax_host_tests::{Bench, opens, rests, set};
use tenax_logic::config::Config;
use tenax_logic::fingertip::Fingertip;
use tenax_logic::setting::SettingId;
use tenax_logic::store::payload;

// Shows R3, R8.
#[test]
fn without_myosensors_the_reflex_works_where_nobody_wears_the_hand_and_nowhere_else() {
    for no_wearer in [true, false] {
        let mut config = Config { line_trusted: true, ..Config::default() };
        config.set(SettingId::NoWearer, no_wearer.into()).unwrap();
        let mut bench = Bench::of(Fingertip::default(), 51);
        bench.fingertip.restore(Kept::Settings, &payload::of_settings(&config));
        bench.pins_mv[MYO_FLEXOR..=MYO_EXTENSOR].fill(0.0);
        bench.run(800);
        bench.load(4.0, 0.6);
        bench.run(800);
        assert_eq!(bench.fingertip.mode(), if no_wearer { GripMode::Watch } else { GripMode::Standby });
        let told = bench.events.iter().filter(|event| matches!(event.kind, EventKind::NoWearer(_)));
        let told: Vec<_> = told.map(|event| (event.frame < 10, event.kind)).collect();
        assert_eq!(told, if no_wearer { vec![(true, EventKind::NoWearer(true))] } else { vec![] });
        bench.vibration_mv = 400.0;
        let drives = bench.run(4_000);
        assert!(if no_wearer { bench.by_reflex() > 20 } else { rests(&drives) });
    }
}

// Shows W1.
#[test]
fn a_muscle_comes_first_even_where_nobody_wears_the_hand() {
    let mut bench = Bench::holding(52);
    bench.accepts(set(SettingId::NoWearer, 1));
    bench.vibration_mv = 400.0;
    bench.run(400);
    assert!(bench.by_reflex() > 20, "the control");
    bench.muscles(400.0, 50.0);
    bench.run(50);
    bench.slows.clear();
    bench.run(2_000);
    assert_eq!(bench.by_reflex(), 0, "silent while it is active");
    bench.muscles(50.0, 900.0);
    assert!(opens(&bench.run(50)));
}
