//! Wires that are cut. With the resistor of docs/hardware.md each of the analogue switches' is noticed; without it a switch's open
//! input keeps its neighbour's charge, and hardly any is. A film's is noticed for its bias is gone.

use rayon::prelude::*;
use tenax_hal_shim::channel::{CHANNELS, COUNT, FRAME_HZ, PVDF, PVDF_COUNT, STRAIN};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{Fault, Reason};
use tenax_scene::{SceneFile, World};
use tenax_sim::board::Run;
use tenax_sim::session::Board;

const BENCH: &str = include_str!("../../scenes/parts/bench.toml");

const CUT_S: u32 = 3;
const WITHIN_S: f64 = 0.5;
const FILM_WITHIN_S: f64 = 0.6;

fn run_of(text: &str, seconds: u32, at_s: u32, channel: usize, kind: &str) -> Run {
    let text = text.replace("= 3600", &format!("= {seconds}"));
    let name = CHANNELS[channel].name;
    let fault =
        format!("\n[[fault]]\nat_s = {at_s}\nchannel = \"{name}\"\nkind = \"{kind}\"\nreason = \"a test\"\n");
    let scene = SceneFile::parse(&(text + &fault), "bench").unwrap_or_else(|error| panic!("{error}"));
    Board::Host.run(World::new(&scene, 1), &mut |_| {}).unwrap().0
}

/// How long after the cut a channel is reported, s, and why.
type Noticed = Option<(f64, Reason)>;

fn noticed_in(run: &Run, channel: usize) -> Noticed {
    run.events.iter().find_map(|event| match event.kind {
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
        .map(|channel| {
            let noticed = |kind| noticed_in(&run_of(BENCH, 5, CUT_S, channel, kind), channel);
            (channel, ["cut", "open"].map(noticed))
        })
        .collect();
    let in_time = |noticed: &Noticed| noticed.is_some_and(|(after_s, _)| (0.0..WITHIN_S).contains(&after_s));
    let late = all.iter().filter(|(_, [cut, _])| !in_time(cut));
    let late: Vec<_> = late.map(|(channel, [cut, _])| (CHANNELS[*channel].name, cut)).collect();
    assert!(late.is_empty(), "{late:?}");
    let unnoticed = all.iter().filter(|(_, [_, open])| open.is_none()).count();
    assert!(unnoticed >= 25, "the control: {unnoticed} of {} are not noticed", all.len());
}

// Shows R5.
#[test]
fn each_film_that_is_cut_before_its_amplifier_is_noticed() {
    (PVDF..PVDF + PVDF_COUNT).into_par_iter().for_each(|channel| {
        let noticed = noticed_in(&run_of(BENCH, 5, CUT_S, channel, "cut"), channel);
        let in_time =
            matches!(noticed, Some((after_s, Reason::Dead)) if (0.0..FILM_WITHIN_S).contains(&after_s));
        assert!(in_time, "{}: {noticed:?}", CHANNELS[channel].name);
    });
}

// Shows R5.
#[test]
fn a_film_that_is_cut_while_the_hand_holds_moves_nothing() {
    // The bench's wearer grips and lifts by keys alone; here as the part that it stands on says.
    let holds = BENCH.replace("without = [\"muscle\", \"move\"]", "");
    for film in PVDF..PVDF + PVDF_COUNT {
        let run = run_of(&holds, 12, 9, film, "cut");
        assert!(noticed_in(&run, film).is_some(), "film {film}");
        let after = run.drives.len() / 12 * 9;
        assert!(
            run.drives[..after].iter().any(|drive| *drive != MotorDrive::Coast),
            "the control: the hand has closed"
        );
        assert!(run.drives[after..].iter().all(|drive| *drive == MotorDrive::Coast), "film {film}");
    }
}
