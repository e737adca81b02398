//! What the image survives, and that it says so.

use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{Answer, Down, EventKind};
use tenax_hal_shim::words::Fault;
use tenax_sim::board::agreement::host_says;
use tenax_sim::board::emulated::{Mishap, Options};
use tenax_sim::board::kept::device;

use crate::{Rest, Swing, drives, run};

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

    // Sequence numbers kept time and the switches kept step: from the next slow frame on, the samples are those that
    // the world had at those instants.
    let host = host_says(&run.scans, device(run.trusts_line, run.calibrated.as_ref()), &[], &[]).slows;
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
    let plant = Rest::new(Swing::new(1.0).sending(0.6, Down::Ping).sending(0.7, Down::Ping));
    let run = run(plant, &with(0.3, Mishap::Garbage(garbage)));
    assert_eq!(run.starts, [None]);
    assert!(run.counters.bad_frames >= 3, "{:?}", run.counters);
    assert_eq!(run.answers, [(1, Answer::Done)], "the second command after it was heard");
    assert!(drives(&run, 0.0, 1.0).iter().all(|drive| *drive == MotorDrive::Coast));
    assert_eq!((run.counters.overruns, run.counters.ticks_late), (0, 0));
}

// Shows B1.
#[test]
fn the_watchdog_stops_a_driven_motor_and_the_next_start_says_so() {
    let drive = MotorDrive::Close(Duty::per_mille(400));
    let command = Down::Drive { drive, hold_ms: 250 };
    let plant = Rest::new(Swing::new(1.5).sending(0.5, command));
    let run = run(plant, &with(0.6, Mishap::CoreHangs));
    assert_eq!(run.starts, [None, Some(Fault::WatchdogReset)]);
    assert!(drives(&run, 0.55, 0.6).iter().all(|now| *now == drive), "it was driven when the core hung");
    assert!(drives(&run, 0.6, 0.65).iter().all(|now| *now == drive), "a hung core leaves it driven");
    // The watchdog's oscillator may be 32 % slow, the emulated one is not.
    assert!(drives(&run, 0.72, 1.5).iter().all(|now| *now == MotorDrive::Coast), "until the watchdog");
    assert!(!drives(&run, 0.0, 1.5).iter().any(|now| now.opens()));
}

// Shows B1.
#[test]
fn a_panic_stops_a_driven_motor_at_once_and_the_next_start_says_so() {
    let drive = MotorDrive::Close(Duty::per_mille(400));
    let command = Down::Drive { drive, hold_ms: 250 };
    let plant = Rest::new(Swing::new(1.0).sending(0.5, command));
    let run = run(plant, &with(0.6, Mishap::DmaFails));
    assert_eq!(run.starts, [None, Some(Fault::PanicReset)]);
    assert!(drives(&run, 0.55, 0.6).iter().all(|now| *now == drive), "it was driven before");
    // DMA stumbles over the next code.
    assert!(drives(&run, 0.601, 1.0).iter().all(|now| *now == MotorDrive::Coast));
}

/// Whichever of a frame's four scans DMA loses its ring in: each start lasts a scan longer than the one before.
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
    let run = run(Rest::new(Swing::new(1.3)), &options);
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
    let run = run(Rest::new(plant), &Options { mishaps, ..Options::default() });
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
