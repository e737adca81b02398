//! What the image survives, and that it says so.

use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{Answer, Down, EventKind};
use tenax_hal_shim::words::{Fault, MotorStop};
use tenax_sim::board::agreement::host_says;
use tenax_sim::board::emulated::{Mishap, Options};
use tenax_sim::board::simulated;

use crate::{Swing, drives, run, scene, stops};

fn with(at_s: f64, mishap: Mishap) -> Options {
    Options { mishaps: vec![(at_s, mishap)], ..Options::default() }
}

// Shows B3.
#[test]
fn an_overrun_costs_a_few_frames_and_is_told() {
    let run = run(Swing::new(2.0), &with(1.0, Mishap::DmaStalls));
    assert_eq!(run.starts, [None], "no reset was needed");
    assert_eq!(run.counters.overruns, 1);
    let lost = run.counters.frames_lost;
    assert!((1..=6).contains(&lost), "{lost} frames lost");
    assert_eq!(run.counters.frames + lost, run.counters.ticks, "lost frames are ticks too");
    let told =
        run.events.iter().any(|event| matches!(event.kind, EventKind::Fault(Fault::FramesLost { .. })));
    assert!(told, "{:?}", run.events);

    // From the next slow frame on, the samples are those that the world had at those instants.
    let host = host_says(&run).slows;
    let same: Vec<bool> =
        host.iter().zip(&run.slows).map(|(host, image)| host.samples_sum == image.samples_sum).collect();
    assert_eq!((same.len(), same.iter().filter(|same| !**same).count()), (160, 1));
    assert!(run.slows.iter().zip(&host).all(|(image, host)| image.frame == host.frame));
}

// Shows L5.
#[test]
fn garbage_on_the_line_is_counted_and_moves_nothing() {
    // Neither a frame nor the start of one: a full period of a shift register, zeros and all.
    let garbage = std::iter::successors(Some(1u8), |&byte| Some(byte.wrapping_mul(5).wrapping_add(3)));
    let garbage = garbage.take(1_500).collect();
    // The garbage does not end in a zero, so it swallows the first command after it; the next one starts clean.
    let plant = Swing::new(1.0).sending(0.6, Down::Ping).sending(0.7, Down::Ping).at_rest();
    let run = run(plant, &with(0.3, Mishap::Garbage(garbage)));
    assert_eq!(run.starts, [None]);
    assert!(run.counters.bad_frames >= 3, "{:?}", run.counters);
    assert_eq!(run.answers, [(1, Answer::Done)], "the second command after it was heard");
    assert!(drives(&run, 0.0, 1.0).iter().all(|drive| *drive == MotorDrive::Coast));
    assert_eq!((run.counters.overruns, run.counters.ticks_late), (0, 0));
}

/// embassy's receiver begins its ring anew after an error, with what was carried out before still in it.
// Shows L5.
#[test]
fn a_line_that_errs_loses_commands_and_carries_none_out_twice() {
    let mishaps = vec![(0.5, Mishap::LineErrs(20_000)), (1.0, Mishap::LineErrs(0))];
    let pings = (0..240)
        .fold(Swing::new(1.4).at_rest(), |plant, n| plant.sending(0.2 + 0.005 * f64::from(n), Down::Ping));
    let run = run(pings, &Options { mishaps, ..Options::default() });
    assert_eq!(run.starts, [None]);
    let answered: Vec<u16> = run.answers.iter().map(|(of, _)| *of).collect();
    assert!(answered.is_sorted_by(|one, next| one < next), "{answered:?}");
    assert!((180..240).contains(&answered.len()), "{} of 240", answered.len());
    assert!(answered.ends_with(&(170..240).collect::<Vec<u16>>()), "{answered:?}");
    assert!(run.counters.bad_frames > 0);
    assert_eq!((run.counters.ticks_late, run.counters.frames_lost), (0, 0));
}

// Shows B1.
#[test]
fn a_hang_and_a_panic_stop_a_driven_motor_and_the_next_start_says_so() {
    // The watchdog's oscillator may be 32 % slow, the emulated one is not; DMA stumbles over the next code.
    for (mishap, fault, off_s) in
        [(Mishap::CoreHangs, Fault::WatchdogReset, 0.72), (Mishap::DmaFails, Fault::PanicReset, 0.601)]
    {
        let drive = MotorDrive::Close(Duty::per_mille(400));
        let plant = Swing::new(1.5).sending(0.5, Down::Drive { drive, hold_ms: 250 }).at_rest();
        let run = run(plant, &with(0.6, mishap));
        assert_eq!(run.starts, [None, Some(fault)]);
        assert!(drives(&run, 0.55, 0.6).iter().all(|now| *now == drive), "it was driven before");
        assert!(drives(&run, off_s, 1.5).iter().all(|now| *now == MotorDrive::Coast), "{fault:?}");
        assert!(!drives(&run, 0.0, 1.5).iter().any(|now| now.opens()));
    }
}

// Shows B1.
#[test]
fn a_hang_and_a_panic_end_a_vibration() {
    let (host, _) = simulated::run(scene("vibrates"));
    let at_s = |frame: u32| f64::from(frame) / 2_000.0;
    let fails_s = at_s(host.feedback[0].0) + 0.02;
    for (mishap, within_s) in [(Mishap::CoreHangs, 0.15), (Mishap::DmaFails, 0.03)] {
        let run = run(scene("vibrates"), &with(fails_s, mishap));
        let [on, off] = [run.feedback[0], run.feedback[1]];
        assert!(on.1 > Duty::default() && at_s(on.0) < fails_s - 0.01, "it was driven before");
        assert_eq!(off.1, Duty::default());
        // To the frame.
        assert!((-0.001..within_s).contains(&(at_s(off.0) - fails_s)), "{:?}", run.feedback);
    }
}

// Shows B9.
#[test]
fn a_bridge_that_reports_a_fault_is_told_until_it_is_well() {
    let mishaps = vec![(0.6, Mishap::BridgeIsOff(true)), (0.9, Mishap::BridgeIsOff(false))];
    let run = run(Swing::new(1.2).at_rest(), &Options { mishaps, ..Options::default() });
    assert_eq!(stops(&run.events), [Some(MotorStop::BridgeOff), None]);
    let told = run.events.iter().filter(|event| matches!(event.kind, EventKind::Motor(_)));
    let frames: Vec<u32> = told.map(|event| event.frame).collect();
    // 0.6 s are 1200 frames; it is asked once a slow frame and told in the next.
    assert!((1_200..1_250).contains(&frames[0]) && (1_800..1_850).contains(&frames[1]), "{frames:?}");
    assert_eq!((run.counters.ticks_late, run.counters.frames_lost), (0, 0));
}

// Shows B3.
#[test]
fn dma_that_cannot_reach_its_ring_is_a_panic_in_every_scan_of_a_frame() {
    let scan_s = 1.0 / f64::from(SCAN_HZ);
    let mut at_s = 0.0;
    let mishaps = (0..5).map(|n| {
        at_s += 0.2 + f64::from(n) * scan_s;
        (at_s, Mishap::DmaFails)
    });
    let options = Options { mishaps: mishaps.collect(), ..Options::default() };
    let run = run(Swing::new(1.3).at_rest(), &options);
    let mut starts = vec![None];
    starts.extend([Some(Fault::PanicReset); 5]);
    assert_eq!(run.starts, starts);
}

// Shows B2.
#[test]
fn a_board_that_restarts_again_and_again_stays_off_in_the_end_and_its_button_opens() {
    let drive = MotorDrive::Close(Duty::per_mille(400));
    let mut plant = Swing::new(4.2).holding(2.5, 1.2);
    // Each time it drives, it hangs or its supply breaks down: so it would close a little further after each restart.
    let (mut mishaps, mut starts) = (Vec::new(), vec![None]);
    for n in 0..6 {
        let at_s = 0.3 + 0.35 * f64::from(n);
        plant = plant.sending(at_s - 0.05, Down::Drive { drive, hold_ms: 250 });
        let hangs = n % 2 == 0;
        mishaps.push((at_s, if hangs { Mishap::CoreHangs } else { Mishap::BrownsOut }));
        starts.push(Some(if hangs { Fault::WatchdogReset } else { Fault::SupplySagged }));
    }
    starts[6] = Some(Fault::TooManyRestarts);
    let run = run(plant.at_rest(), &Options { mishaps, ..Options::default() });
    assert_eq!(run.starts, starts);
    let last = 0.3 + 0.35 * 5.0;
    assert!(drives(&run, 0.0, last).contains(&drive), "before, it does what it is told");
    assert!(drives(&run, last + 0.15, 3.7).iter().all(|now| *now == MotorDrive::Coast));
    let opens = MotorDrive::Open(Duty::per_mille(300));
    assert!(
        drives(&run, 3.75, 4.2).iter().all(|now| *now == opens),
        "somebody has held and let go of the button"
    );
}
