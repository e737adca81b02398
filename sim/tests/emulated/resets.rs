//! Resets of every cause in any order: each start tells its own, the black box keeps what was said before the first fault, and
//! restarts count only where the hand brought them about.
//!
//! `TENAX_RESETS=1000` has about so many of each cause. The emulator translates the image anew after each: some seconds of a core.

use std::env;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_frames::link::Inbox;
use tenax_hal_shim::wire::{Answer, Down, EventKind, Last, ResetCause, Up};
use tenax_hal_shim::words::Fault;
use tenax_logic::restart::RESTARTS_MAX;
use tenax_sim::board::emulated::{Mishap, Options};

use crate::{Rest, Swing, run};

/// A reset with what follows it, s; how long it takes until the board is up again, s; and what its start says.
type Kind = (fn() -> Vec<(f64, Mishap)>, f64, ResetCause, Option<Fault>);

const KINDS: [Kind; 6] = [
    (|| vec![(0.0, Mishap::ResetByPin)], 0.25, ResetCause::Pin, None),
    (|| vec![(0.0, Mishap::BrownsOut)], 0.25, ResetCause::Other, Some(Fault::SupplySagged)),
    (
        || vec![(0.0, Mishap::SupplyIs(2_900)), (0.002, Mishap::SupplyIs(3_300))],
        0.25,
        ResetCause::Software,
        Some(Fault::SupplySagged),
    ),
    // The watchdog takes 0.1 s.
    (|| vec![(0.0, Mishap::CoreHangs)], 0.4, ResetCause::Watchdog, Some(Fault::WatchdogReset)),
    (|| vec![(0.0, Mishap::DmaFails)], 0.25, ResetCause::Panic, Some(Fault::PanicReset)),
    (|| vec![(0.0, Mishap::CrystalStops(true))], 0.25, ResetCause::Software, Some(Fault::CrystalLost)),
];
const PIN: usize = 0;
const CRYSTAL: usize = 5;

/// Resets of one run: what it samples is kept, 0.1 MB for each.
const OF_A_RUN: usize = 60;

#[test]
#[ignore = "minutes: each reset is a boot"]
fn every_reset_is_told_right_whatever_was_before() {
    let each = env::var("TENAX_RESETS").ok().map(|each| each.parse().expect("TENAX_RESETS is a number"));
    let count = each.map_or(OF_A_RUN, |each: usize| each * KINDS.len());
    let mut told = [0; KINDS.len()];
    for (seed, from) in (0..).zip((0..count).step_by(OF_A_RUN)) {
        let of_run = told_right(seed, OF_A_RUN.min(count - from));
        told.iter_mut().zip(of_run).for_each(|(told, more)| *told += more);
        println!("{told:?} resets of each kind told right");
    }
}

/// Draws so many resets and checks what is told of them; how many there were of each kind.
fn told_right(seed: u64, count: usize) -> [usize; KINDS.len()] {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut of_kind = [0; KINDS.len()];
    let (mut at_s, mut mishaps, mut expected, mut in_a_row) = (0.4, Vec::new(), Vec::new(), 0);
    let (mut plant, mut boxes, mut kept) = (Swing::new(0.0), Vec::new(), None::<Fault>);
    for _ in 0..count {
        // One that stays off needs the button.
        let kind = if in_a_row > RESTARTS_MAX { PIN } else { random.random_range(0..KINDS.len()) };
        let (mishap, takes_s, cause, fault) = KINDS[kind];
        mishaps.extend(mishap().into_iter().map(|(after_s, mishap)| (at_s + after_s, mishap)));
        of_kind[kind] += 1;
        in_a_row = match kind {
            PIN => 0,
            CRYSTAL => in_a_row,
            _ => in_a_row + 1,
        };
        let stays_off = in_a_row > RESTARTS_MAX;
        let fault = if stays_off { Some(Fault::TooManyRestarts) } else { fault };
        expected.push((fault, (!stays_off).then_some(cause)));
        kept = kept.or(fault);
        if stays_off {
            // It takes no commands.
            at_s += takes_s + 0.05;
            continue;
        }
        // Any phase of a frame and of a slow frame.
        at_s += takes_s + random.random_range(0.0..0.013);
        plant = plant.sending(at_s, Down::Last(0));
        boxes.push(kept);
        // Now and then somebody has read it all.
        if random.random_range(0..4) == 0 {
            plant = plant.sending(at_s + 0.02, Down::Last(u16::MAX));
            kept = None;
        }
        at_s += 0.05;
    }
    plant.duration_s = at_s + 0.1;
    let run = run(Rest::new(plant), &Options { mishaps, ..Options::default() });

    let mut inbox = Inbox::default();
    let heard =
        run.line.iter().filter_map(|&byte| inbox.push(byte)).flatten().map(|heard| heard.received.message);
    let (mut starts, mut lasts) = (Vec::new(), Vec::<Last>::new());
    for message in heard {
        match message {
            Up::Hello { after, .. } => starts.push((after, None)),
            Up::About(about) => starts.last_mut().unwrap().1 = Some(about.identity.reset),
            Up::Answer { answer: Answer::Last(last), .. } if last.from == 0 => lasts.push(last),
            _ => {}
        }
    }
    // The first start was no reset.
    assert_eq!(starts.len(), 1 + expected.len());
    for (n, (told, expected)) in starts[1..].iter().zip(&expected).enumerate() {
        assert_eq!(told, expected, "reset {n} after {:?}", &starts[n.saturating_sub(3)..=n]);
    }
    let told: Vec<_> = lasts.iter().map(|last| last.after).collect();
    assert_eq!(told, boxes);
    let faults =
        run.events.iter().filter(|event| matches!(event.kind, EventKind::Fault(Fault::FramesLost { .. })));
    assert_eq!(faults.count(), 0, "no start has lost a frame");
    of_kind
}

/// The clock stops and does not come back: the board works on its own oscillator and says so. With the crystal back, the next start is
/// on it.
// Shows B2.
#[test]
fn a_lost_clock_is_survived_and_taken_up_again_when_it_is_back() {
    let mishaps = vec![
        (0.2, Mishap::CrystalStops(false)),
        (0.5, Mishap::CrystalStops(true)),
        (0.5, Mishap::ResetByPin),
    ];
    let run = run(Rest::new(Swing::new(0.8)), &Options { mishaps, ..Options::default() });
    assert_eq!(run.starts, [None, Some(Fault::CrystalLost), None]);
    // The start without a crystal reports it, and the last has it.
    let told = run.events.iter().filter(|event| event.kind == EventKind::Fault(Fault::CrystalLost));
    assert_eq!(told.count(), 1);
    assert_eq!((run.counters.overruns, run.counters.frames_lost), (0, 0));
}

/// A rail that is too low for the motor is no silence: the board says why, and starts when there is enough.
#[test]
fn a_low_supply_is_told_and_waited_for() {
    let mishaps = vec![(0.4, Mishap::SupplyIs(2_900)), (2.4, Mishap::SupplyIs(3_100))];
    let run = run(Rest::new(Swing::new(3.0)), &Options { mishaps, ..Options::default() });
    // It is reset, waits for a second, says why, and is reset again when the supply is there.
    assert_eq!(run.starts, [None, Some(Fault::SupplySagged), None]);
    let frames = run.counters.frames;
    assert!((600..1_300).contains(&frames), "{frames} frames of the last start");
}
