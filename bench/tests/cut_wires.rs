//! Wires of the analogue switches that are cut: with the resistor of docs/hardware.md each is noticed, without it a switch's open
//! input keeps its neighbour's charge, and hardly any is.

use rayon::prelude::*;
use tenax_bench::board::Run;
use tenax_bench::session::Board;
use tenax_hal_shim::channel::{CHANNELS, COUNT, FRAME_HZ, STRAIN};
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{Fault, Reason};
use tenax_scene::{SceneFile, World};

/// When the wire is cut, and how soon that has to be noticed, s.
const CUT_S: u32 = 3;
const WITHIN_S: f64 = 0.5;

fn run(channel: usize, kind: &str) -> Run {
    let bench = include_str!("../../scenes/parts/bench.toml").replace("= 3600", "= 5");
    let name = CHANNELS[channel].name;
    let fault = format!(
        "\n[[fault]]\nat_s = {CUT_S}\nchannel = \"{name}\"\nkind = \"{kind}\"\nreason = \"a test\"\n"
    );
    let scene = SceneFile::parse(&(bench + &fault), "bench").unwrap_or_else(|error| panic!("{error}"));
    Board::Host.run(World::new(&scene, 1), &mut |_| {}).unwrap().0
}

/// How long after the cut a channel is reported, s, and why.
type Noticed = Option<(f64, Reason)>;

fn noticed(channel: usize, kind: &str) -> Noticed {
    run(channel, kind).events.iter().find_map(|event| match event.kind {
        EventKind::Fault(Fault::SensorLost { channel: lost, reason }) if usize::from(lost) == channel => {
            Some((f64::from(event.frame) / f64::from(FRAME_HZ) - f64::from(CUT_S), reason))
        }
        _ => None,
    })
}

// Shows R5.
#[test]
fn each_of_the_thirty_is_noticed_with_its_resistor_and_hardly_one_without() {
    let all: Vec<(usize, [Noticed; 2])> = (STRAIN..COUNT)
        .into_par_iter()
        .map(|channel| (channel, ["cut", "open"].map(|kind| noticed(channel, kind))))
        .collect();
    for (channel, [cut, open]) in &all {
        println!("{:<14} with resistor {cut:?}, without {open:?}", CHANNELS[*channel].name);
    }
    let late: Vec<_> = all
        .iter()
        .filter(|(_, [cut, _])| !cut.is_some_and(|(after_s, _)| (0.0..WITHIN_S).contains(&after_s)))
        .map(|(channel, [cut, _])| (CHANNELS[*channel].name, cut))
        .collect();
    assert!(late.is_empty(), "{late:?}");
    let unnoticed = all.iter().filter(|(_, [_, open])| open.is_none()).count();
    assert!(unnoticed >= 25, "the control: {unnoticed} of {} are not noticed", all.len());
}
