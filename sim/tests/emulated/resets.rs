//! Resets by a lost clock and a low supply: each start says why, and the board goes on with what there is.

use rand::rngs::ChaCha8Rng;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{Fault, Kept};
use tenax_sim::board::Run;
use tenax_sim::board::emulated::{Mishap, Options};
use tenax_sim::board::kept::Sectors;

use crate::{Swing, plain, run};

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

// Shows B2.
#[test]
fn a_pll_that_does_not_lock_on_the_crystal_is_told_and_run_without_it() {
    let mishaps = vec![(0.2, Mishap::PllFails), (0.2, Mishap::ResetByPin)];
    let run = run(Swing::new(0.6).at_rest(), &Options { mishaps, ..Options::default() });
    assert_eq!(run.starts, [None, None]);
    assert!(run.events.iter().any(|event| event.kind == EventKind::Fault(Fault::CrystalLost)));
}

// Shows B1.
#[test]
fn a_hang_before_control_runs_ends_in_a_reset() {
    let mishaps = vec![(0.2, Mishap::CoreHangs)];
    let run = run(Swing::new(9.0).at_rest(), &Options { supply_mv: 2_900, mishaps, ..Options::default() });
    assert_eq!(run.starts, [Some(Fault::SupplySagged), Some(Fault::WatchdogReset)]);
}

// Shows B2.
#[test]
fn a_low_supply_is_told_and_waited_for() {
    let mishaps = vec![(0.4, Mishap::SupplyIs(2_900)), (2.4, Mishap::SupplyIs(3_100))];
    let run = run(Swing::new(3.0).at_rest(), &Options { mishaps, ..Options::default() });
    // It is reset, says why, and goes on when the supply is there.
    assert_eq!(run.starts, [None, Some(Fault::SupplySagged)]);
    let frames = run.counters.frames;
    assert!((600..1_300).contains(&frames), "{frames} frames of the last start");
}

// Shows B2.
#[test]
fn a_wrong_brown_out_level_is_told_and_left_to_the_probe() {
    let told =
        |run: &Run| run.events.iter().any(|event| event.kind == EventKind::Fault(Fault::BrownOutLevel));
    let run = run(Swing::new(0.3).at_rest(), &Options { brown_out_level: 3, ..Options::default() });
    assert!(told(&run) && !told(plain()));
}

// Shows B2.
#[test]
fn without_a_brown_out_level_a_low_supply_is_waited_for_at_16_mhz() {
    let run = |mishaps| {
        let options = Options { brown_out_level: 3, supply_mv: 2_900, mishaps, ..Options::default() };
        run(Swing::new(1.5).at_rest(), &options)
    };
    let low = run(Vec::new());
    assert_eq!((low.starts.len(), low.line.len()), (0, 0), "its line needs a faster clock");
    assert_eq!(run(vec![(0.5, Mishap::SupplyIs(3_300))]).starts, [Some(Fault::SupplySagged)]);
}

// Shows B2.
#[test]
fn a_hand_whose_supply_sags_slowly_at_each_closing_stays_off_in_the_end() {
    let sags = (0..6).map(|n| 0.2 + 0.7 * f64::from(n));
    let mishaps =
        sags.flat_map(|at_s| [(at_s, Mishap::SupplyIs(2_900)), (at_s + 0.4, Mishap::SupplyIs(3_300))]);
    let options = Options { mishaps: mishaps.collect(), ..Options::default() };
    let mut starts = vec![Some(Fault::SupplySagged); 7];
    (starts[0], starts[6]) = (None, Some(Fault::TooManyRestarts));
    assert_eq!(run(Swing::new(4.4).at_rest(), &options).starts, starts);
}

/// Rounds in one run: runs are independent, so cores share them.
const ROUNDS: usize = 10;

/// One of each cause; `TENAX_RESETS=300` is the bar, and `host-tests/tests/restart.rs` draws thousands.
// Shows B2.
#[test]
fn resets_in_a_drawn_order_are_each_told_right() {
    let causes = [
        (Mishap::CoreHangs, Fault::WatchdogReset),
        (Mishap::DmaFails, Fault::PanicReset),
        (Mishap::CoreStrays, Fault::PanicReset),
        (Mishap::BrownsOut, Fault::SupplySagged),
        (Mishap::SupplyIs(2_900), Fault::SupplySagged),
        (Mishap::CrystalStops(true), Fault::CrystalLost),
    ];
    let rounds: usize = std::env::var("TENAX_RESETS").map_or(1, |count| count.parse().expect("a number"));
    (0..rounds).into_par_iter().step_by(ROUNDS).for_each(|first| {
        let mut random = ChaCha8Rng::seed_from_u64(52 + first as u64);
        let (mut at_s, mut mishaps, mut starts) = (0.25, Vec::new(), vec![None]);
        for _ in first..rounds.min(first + ROUNDS) {
            let mut drawn = causes.clone();
            drawn.shuffle(&mut random);
            for (mishap, fault) in drawn {
                mishaps.extend([(at_s, mishap), (at_s + 0.12, Mishap::SupplyIs(3_300))]);
                starts.push(Some(fault));
                at_s += random.random_range(0.2..0.3);
            }
            // Six restarts in a row would leave the hand off; the pin's is none, nor is a lost crystal's.
            mishaps.push((at_s, Mishap::ResetByPin));
            starts.push(None);
            at_s += random.random_range(0.1..0.2);
        }
        let run = run(Swing::new(at_s).at_rest(), &Options { mishaps, ..Options::default() });
        assert_eq!(run.starts, starts, "from round {first}");
    });
}

#[test]
fn nothing_is_erased_or_programmed_while_the_supply_is_low() {
    // Switched on, the image makes room in a sector that is half full.
    let full = (0..208u8).fold(Sectors::blank(), |sectors, n| sectors.saving(Kept::Network, &[n; 296]));
    let run = |mishaps| {
        let options = Options { supply_mv: 2_900, mishaps, flash: Some(full.image()), ..Options::default() };
        run(Swing::new(3.5).at_rest(), &options)
    };
    let low = run(Vec::new());
    assert_eq!(
        (low.flash.erases, low.flash.words, &low.starts[..]),
        (0, 0, &[Some(Fault::SupplySagged)][..])
    );
    // The control: when the supply has risen, it does.
    let risen = run(vec![(0.2, Mishap::SupplyIs(3_300))]);
    assert_eq!((risen.flash.erases, &risen.starts[..]), (1, &[Some(Fault::SupplySagged)][..]));
    assert!(risen.counters.frames > 0);
}
