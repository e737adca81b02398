//! The quick models of the chip, which take a scan at once, do what an event for each conversion and edge does.

use std::sync::mpsc;

use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::Down;
use tenax_hal_shim::words::{Code, Fault};
use tenax_sim::board::Run;
use tenax_sim::board::emulated::{Mishap, Models, Options, Tick};

use crate::{Swing, run};

fn eventful(models: Models) -> (Run, Vec<Tick>) {
    let mut plant = Swing::new(1.9);
    for n in 0..40 {
        let at_s = 0.1 + f64::from(n) * 0.04;
        let drive = MotorDrive::Open(Duty::per_mille(100 + n));
        plant = plant.sending(at_s, Down::Drive { drive, hold_ms: 10 });
        plant = plant.sending(at_s + 0.013, Down::Teach { codes: [Code::Minus, Code::Plus], age_ms: 40 });
    }
    plant = plant.sending(0.25, Down::Save).sending(1.6, Down::Network);
    let mishaps = vec![
        (0.5, Mishap::DmaFails),
        (0.75, Mishap::DmaStalls),
        (0.901_375, Mishap::DmaStalls),
        (1.0, Mishap::Garbage((0..200u8).collect())),
        (1.3, Mishap::CoreHangs),
    ];
    let (ticks, heard) = mpsc::channel();
    let options = Options { mishaps, models, ticks: Some(ticks), ..Options::default() };
    let run = run(plant, &options);
    drop(options);
    (run, heard.iter().collect())
}

#[test]
fn a_scan_at_once_is_a_scan_code_by_code() {
    let (quick, quick_ticks) = eventful(Models::Quick);
    let (each, each_ticks) = eventful(Models::Rigless);
    // It was eventful.
    assert_eq!(quick.starts, [None, Some(Fault::PanicReset), Some(Fault::WatchdogReset)]);
    assert!(quick.slows.len() > 100 && quick.flash.words > 70 && quick_ticks.len() > 3_000);

    // Every tick began at the same instant, and from one to the next the core ran as many instructions; but for one interrupt
    // or two of the serial line in all, which fall into the same instant as a code and are served once more.
    assert_eq!(quick_ticks.len(), each_ticks.len());
    let both = || quick_ticks.iter().zip(&each_ticks);
    assert_eq!(both().position(|(quick, each)| quick.at_ns != each.at_ns), None);
    let apart = both().map(|(quick, each)| quick.instruction_count.wrapping_sub(each.instruction_count));
    let apart: Vec<u64> = apart.collect();
    let moved = apart.windows(2).filter(|two| two[0] != two[1]).count();
    assert!(moved <= 2, "{moved} of {} ticks", quick_ticks.len());
    let (own, theirs) = (quick.tick_cost.expect("counted"), each.tick_cost.expect("counted"));
    assert!(
        own.count == theirs.count && (own.instructions_mean - theirs.instructions_mean).abs() < 1.0,
        "{own:?} {theirs:?}"
    );
    // The world saw the same, and byte for byte the same came up the line.
    assert!(quick.scans == each.scans && quick.drives == each.drives && quick.line == each.line);
    assert_eq!((&quick.slows, &quick.events), (&each.slows, &each.events));
    assert_eq!((&quick.taken, &quick.answers, &quick.saved), (&each.taken, &each.answers, &each.saved));
    assert_eq!((&quick.starts, quick.flash), (&each.starts, each.flash));
    assert_eq!((quick.counters, quick.stack_bytes), (each.counters, each.stack_bytes));
}
