//! A select line of the analogue switches that is cut, stuck or shorted: the switches show other inputs than the board asks for.

use tenax_hal_shim::channel::{ARRAY, ARRAY_COUNT, CHANNELS, FSR, Input, MYO_EXTENSOR, MYO_FLEXOR, OPENING};
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{Capability, Fault, Reason};
use tenax_host_tests::{Bench, opens, rests};

fn each() -> impl Iterator<Item = [u8; 2]> {
    (0..4).flat_map(|line| [[1 << line, 0], [0, 1 << line]])
}

// Shows R5, W4.
#[test]
fn every_stuck_line_takes_all_switched_sensors_within_0_1_s_and_opens_nothing() {
    for lines in each() {
        let mut bench = Bench::holding(81);
        bench.stuck_lines = lines;
        let stuck_at = bench.frames;
        assert!(rests(&bench.run(4_000)), "{lines:?}");
        // Stuck high, S1 and S3 leave both muscles where they are, and S2 shows them voltages that no muscle has.
        let muscles = if lines[1] > 1 { &[][..] } else { &[MYO_FLEXOR, MYO_EXTENSOR] };
        for &channel in [FSR].iter().chain(muscles) {
            let dead = bench.lost(channel).into_iter().find(|(_, reason)| *reason == Reason::Dead);
            let after = dead.map(|(frame, _)| frame - stuck_at);
            let in_time = after.is_some_and(|frames| frames <= 200);
            assert!(in_time, "{lines:?}, {}: {after:?}", CHANNELS[channel].name);
        }
        bench.muscles(50.0, 900.0);
        assert_eq!(
            opens(&bench.run(800)),
            [[0, 2], [0, 8]].contains(&lines),
            "{lines:?}: muscles still command"
        );
        bench.muscles(50.0, 50.0);
        bench.run(400);
        bench.stuck_lines = [0; 2];
        bench.run(8_000);
        let back = EventKind::Fault(Fault::CapabilityBack(Capability::Force));
        assert!(bench.count(back) > 0, "{lines:?}: the force is known again");
    }
}

// Shows R5, W4.
#[test]
fn with_a_stuck_line_no_voltage_of_another_sensor_opens_the_hand() {
    for lines in each() {
        let mut bench = Bench::holding(82);
        bench.stuck_lines = lines;
        bench.run(400);
        for n in 0..40 {
            bench.press(f64::from(n % 5) * 500.0);
            assert!(!opens(&bench.run(100)), "{lines:?}");
        }
    }
}

#[test]
fn no_other_fault_is_taken_for_a_stuck_line() {
    for channel in (0..CHANNELS.len()).filter(|n| !matches!(CHANNELS[*n].input, Input::Direct { .. })) {
        for mv in [0.0, 3_300.0] {
            let mut bench = Bench::new(84);
            bench.run(400);
            bench.pins_mv[channel] = mv;
            bench.run(400);
            let others_work = |other| other == channel || bench.lost(other).is_empty();
            assert!((0..CHANNELS.len()).all(others_work), "{} at {mv} mV", CHANNELS[channel].name);
        }
    }
}

/// A shorted input beside a dead one looks like a line that is stuck high.
// Shows W4.
#[test]
fn two_broken_neighbours_do_not_make_the_hand_deaf_to_the_wearer() {
    for even in (ARRAY..ARRAY + ARRAY_COUNT).step_by(2).chain([OPENING]) {
        let mut bench = Bench::holding(85);
        (bench.pins_mv[even], bench.pins_mv[even + 1]) = (3_300.0, 0.0);
        bench.run(800);
        bench.muscles(50.0, 900.0);
        assert!(opens(&bench.run(800)), "{}", CHANNELS[even].name);
    }
}
