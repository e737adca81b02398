//! Resets by a lost clock and a low supply: each start says why, and the board goes on with what there is.

use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::Fault;
use tenax_sim::board::emulated::{Mishap, Options};

use crate::{Swing, run};

// Shows B2.
#[test]
fn a_lost_clock_is_survived_and_taken_up_again_when_it_is_back() {
    let mishaps = vec![
        (0.2, Mishap::CrystalStops(false)),
        (0.5, Mishap::CrystalStops(true)),
        (0.5, Mishap::ResetByPin),
    ];
    let run = run(Swing::new(0.8).at_rest(), &Options { mishaps, ..Options::default() });
    assert_eq!(run.starts, [None, Some(Fault::CrystalLost), None]);
    // The start without a crystal reports it, and the last has it.
    let told = run.events.iter().filter(|event| event.kind == EventKind::Fault(Fault::CrystalLost));
    assert_eq!(told.count(), 1);
    assert_eq!((run.counters.overruns, run.counters.frames_lost), (0, 0));
}

#[test]
fn a_low_supply_is_told_and_waited_for() {
    let mishaps = vec![(0.4, Mishap::SupplyIs(2_900)), (2.4, Mishap::SupplyIs(3_100))];
    let run = run(Swing::new(3.0).at_rest(), &Options { mishaps, ..Options::default() });
    // It is reset, waits for a second, says why, and is reset again when the supply is there.
    assert_eq!(run.starts, [None, Some(Fault::SupplySagged), None]);
    let frames = run.counters.frames;
    assert!((600..1_300).contains(&frames), "{frames} frames of the last start");
}

// Shows B2.
#[test]
fn a_wrong_brown_out_level_is_told_and_left_to_the_probe() {
    let told = |brown_out_level| {
        let run = run(Swing::new(0.3).at_rest(), &Options { brown_out_level, ..Options::default() });
        run.events.iter().any(|event| event.kind == EventKind::Fault(Fault::BrownOutLevel))
    };
    assert!(told(3) && !told(0));
}
