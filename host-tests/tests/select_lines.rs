//! A select line of the analogue switches that is cut, stuck or shorted: the switches show other inputs than the board asks for.

use tenax_hal_shim::channel::{ARRAY, ARRAY_COUNT, CHANNELS, FSR, Input, MYO_EXTENSOR, MYO_FLEXOR, OPENING};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{Capability, Fault, Reason};
use tenax_host_tests::Bench;

/// Lines S0 to S3, each stuck low and high, as [`Bench::stuck_lines`] has them.
fn each() -> impl Iterator<Item = [u8; 2]> {
    (0..4).flat_map(|line| [[1 << line, 0], [0, 1 << line]])
}

fn is_lost(bench: &Bench, channel: usize) -> bool {
    let lost = |event: &tenax_hal_shim::wire::Event| matches!(event.kind, EventKind::Fault(Fault::SensorLost { channel: lost, .. }) if usize::from(lost) == channel);
    bench.events.iter().any(lost)
}

// Shows R5, W4.
#[test]
fn every_stuck_line_takes_all_switched_sensors_within_0_1_s_and_opens_nothing() {
    for lines in each() {
        let mut bench = Bench::holding(81);
        bench.stuck_lines = lines;
        let drives = bench.run(4_000);
        // Stuck high, S1 and S3 leave both muscles where they are, and S2 shows them voltages that no muscle has.
        let muscles = if lines[1] > 1 { &[][..] } else { &[MYO_FLEXOR, MYO_EXTENSOR] };
        for &channel in [FSR].iter().chain(muscles) {
            let told = bench.events.iter().find(|event| {
                matches!(event.kind, EventKind::Fault(Fault::SensorLost { channel: lost, reason })
                    if usize::from(lost) == channel && reason == Reason::Dead)
            });
            let after = told.map(|event| event.frame - (bench.frames - 4_000));
            assert!(
                after.is_some_and(|frames| frames <= 200),
                "{lines:?}, {}: {after:?}",
                CHANNELS[channel].name
            );
        }
        assert!(drives.iter().all(|drive| *drive == MotorDrive::Coast), "{lines:?}");
        bench.muscles(50.0, 900.0);
        let opens = bench.run(800).iter().any(|drive| drive.opens());
        assert_eq!(opens, [[0, 2], [0, 8]].contains(&lines), "{lines:?}: who still commands");
        bench.muscles(50.0, 50.0);
        bench.run(400);
        bench.stuck_lines = [0; 2];
        bench.run(8_000);
        let back = EventKind::Fault(Fault::CapabilityBack(Capability::Force));
        assert!(bench.events.iter().any(|event| event.kind == back), "{lines:?}: the force is known again");
    }
}

/// What muscles command while a line is stuck is nobody's command.
// Shows R5, W4.
#[test]
fn with_a_stuck_line_no_voltage_of_another_sensor_opens_the_hand() {
    for lines in each() {
        let mut bench = Bench::holding(82);
        bench.stuck_lines = lines;
        bench.run(400);
        // The array and the gauges swing, whichever the switches show.
        let mut opened = 0;
        for n in 0..40 {
            bench.press(f64::from(n % 5) * 500.0);
            opened += bench.run(100).iter().filter(|drive| drive.opens()).count();
        }
        assert_eq!(opened, 0, "{lines:?}");
    }
}

/// The controls: without the inputs of known voltage a stuck line leaves sensors that read another one's voltage, and nothing is lost
/// for good that works.
#[test]
fn without_the_known_inputs_it_is_not_noticed_and_no_other_fault_is_taken_for_it() {
    let unnoticed = each().filter(|lines| {
        let mut bench = Bench::new(83);
        bench.known_inputs = false;
        bench.run(400);
        bench.stuck_lines = *lines;
        bench.run(1_000);
        !is_lost(&bench, FSR)
    });
    assert!(unnoticed.count() >= 6);
    for channel in (0..CHANNELS.len()).filter(|n| !matches!(CHANNELS[*n].input, Input::Direct { .. })) {
        for mv in [0.0, 3_300.0] {
            let mut bench = Bench::new(84);
            bench.run(400);
            bench.pins_mv[channel] = mv;
            bench.run(400);
            let others =
                (0..CHANNELS.len()).filter(|other| *other != channel && is_lost(&bench, *other)).count();
            assert_eq!(others, 0, "{} at {mv} mV", CHANNELS[channel].name);
        }
    }
}

/// Two neighbours of which one is shorted and the other dead look like a line that is stuck high: the wearer still opens.
// Shows W4.
#[test]
fn two_broken_neighbours_do_not_make_the_hand_deaf_to_the_wearer() {
    for even in (ARRAY..ARRAY + ARRAY_COUNT).step_by(2).chain([OPENING]) {
        let mut bench = Bench::holding(85);
        (bench.pins_mv[even], bench.pins_mv[even + 1]) = (3_300.0, 0.0);
        bench.run(800);
        bench.muscles(50.0, 900.0);
        assert!(bench.run(800).iter().any(|drive| drive.opens()), "{}", CHANNELS[even].name);
    }
}
