//! The image takes every code right and decides what the host's own build of the logic decides.

use std::collections::BTreeMap;
use std::num::NonZeroU64;

use rayon::prelude::*;
use tenax_hal_shim::behaviour::Ending;
use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{Answer, Down, EventKind, Setting, Slow};
use tenax_hal_shim::words::{Code, MotorStop};
use tenax_logic::setting::SettingId;
use tenax_scene::builtin;
use tenax_sim::board::Run;
use tenax_sim::board::agreement::Agreement;
use tenax_sim::board::emulated::Options;
use tenax_sim::board::hash::of_run;
use tenax_sim::board::simulated;
use tenax_sim::session;

use crate::hash::compare;
use crate::{Swing, agrees, plain, run, scene, stops};

// Shows B8.
#[test]
fn ten_seconds_without_a_lost_code() {
    let run = plain();
    assert_eq!(run.starts, [None]);
    let counters = run.counters;
    assert_eq!((counters.overruns, counters.frames_lost, counters.ticks_late), (0, 0, 0));
    assert_eq!((counters.telemetry_dropped, counters.bad_frames), (0, 0));
    assert_eq!((run.bad_frames, run.messages_missed), (0, 0));
    assert_eq!(counters.ticks, counters.frames);
    assert!(counters.frames > 19_500, "{counters:?}");
    // Each slow frame carries the CRC of its samples, so this is every code of every channel too.
    assert_eq!(run.slows.len(), 800);
    agrees("swing", run);
    // The control: one code off by one is another CRC.
    let mut wrong = run.clone();
    wrong.scans[250][3] ^= 1;
    assert!(!Agreement::of(&wrong).holds());
}

/// The default scene's line of the golden gate (`tests/golden.rs`) on the emulated board.
#[test]
fn the_default_scene_decides_as_held() {
    let hash = of_run(&run(scene(session::DEFAULT_SCENE), &Options::default()));
    compare("emulated", &BTreeMap::from([(format!("{} 1", session::DEFAULT_SCENE), hash)]));
}

fn did_as_asked(run: &Run) -> bool {
    run.events.iter().any(|event| matches!(event.kind, EventKind::Behaviour(_, Some(Ending::Done))))
}

fn stalled(run: &Run) -> bool {
    let stalls = [MotorStop::ClosingStalled, MotorStop::OpeningStalled];
    stops(&run.events) == stalls.map(|stop| [Some(stop), None]).concat()
}

fn head_acted(run: &Run) -> bool {
    let acts = |slow: &Slow| slow.ticks.iter().any(|tick| tick.acted.contains(DetectorId::Photoelastic));
    run.slows.iter().any(acts)
}

fn vibrated(run: &Run) -> bool {
    run.feedback.len() >= 4 && run.feedback.last().is_some_and(|last| last.1 == Duty::default())
}

type Happened = fn(&Run) -> bool;

/// Scenes of which each tick is compared, each with what must happen in it. `TENAX_SCENES=all`: every shipped one besides.
const SCENES: [(&str, Happened); 6] = [
    ("hand-over-can", did_as_asked),
    ("turn-pen", did_as_asked),
    ("push-hold", did_as_asked),
    ("jam", stalled),
    ("head-alone", head_acted),
    ("vibrates", vibrated),
];

// Shows B8, B9.
#[test]
fn the_image_decides_every_scene_as_the_host() {
    let mut scenes = SCENES.to_vec();
    if std::env::var("TENAX_SCENES").is_ok_and(|own| own == "all") {
        scenes.extend(builtin().iter().map(|(name, _)| (*name, (|_| true) as Happened)));
    }
    scenes.into_par_iter().for_each(|(name, happened)| {
        let run = run(scene(name), &Options::default());
        agrees(name, &run);
        assert_eq!((run.counters.frames_lost, run.bad_frames), (0, 0), "{name}");
        assert!(run.counters.ticks_late <= u32::from(name == "head-alone"), "{name}: {:?}", run.counters);
        assert!(happened(&run), "{name}: {:?}", run.events);
    });
}

#[test]
fn the_simulated_board_keeps_the_images_time() {
    let image = plain();
    let (host, _) = simulated::run(Swing::new(image.virtual_s));
    assert!(host.scans == image.scans);
    assert_eq!(host.drives, image.drives);
    assert_eq!(host.slows, image.slows);
    assert_eq!(host.events, image.events);
}

/// From two cycles an instruction to one: a late tick decides and drives the same.
// Shows B7, B8.
#[test]
fn decisions_are_the_same_at_50_67_and_100_million_instructions_a_second() {
    let runs = [50, 67, 100].map(|millions: u64| {
        let instructions_per_second = NonZeroU64::new(millions * 1_000_000).expect("not zero");
        let run = run(Swing::new(2.0), &Options { instructions_per_second, ..Options::default() });
        let counters = run.counters;
        assert_eq!((counters.overruns, counters.frames_lost), (0, 0), "{millions} M");
        assert_eq!((counters.telemetry_dropped, run.messages_missed), (0, 0), "{millions} M");
        agrees("swing", &run);
        run
    });
    let late = runs.each_ref().map(|run| run.counters.ticks_late);
    assert!(late[0] >= late[1] && late[1] >= late[2] && late[2] == 0, "{late:?}");
    assert!(late[0] <= runs[0].counters.ticks / 5, "{late:?}");
    for run in &runs[..2] {
        assert!(run.scans == runs[2].scans);
        assert_eq!(run.slows, runs[2].slows);
        assert_eq!(run.drives, runs[2].drives, "a late tick drives in the same scan");
    }
}

/// Commands at every scan of a frame, and some at once: a late one is taken a tick later.
#[test]
fn the_host_says_the_same_when_it_takes_each_command_in_the_images_tick() {
    let mut plant = Swing::new(1.5);
    for n in 0..40 {
        let at_s = 0.2 + f64::from(n) * 0.025 + f64::from(n % 4) / f64::from(SCAN_HZ);
        let drive = MotorDrive::Open(Duty::per_mille(100 + n));
        plant = plant.sending(at_s, Down::Drive { drive, hold_ms: 10 });
        plant = plant.sending(at_s, Down::Teach { codes: [Code::Minus, Code::Plus], age_ms: 40 });
        if n % 10 == 9 {
            plant = plant
                .sending(at_s, Down::Set(Setting { id: SettingId::S2.number(), value: n.into() }))
                .sending(at_s, Down::Network);
        }
    }
    // Muscles at rest: active ones refuse every drive.
    let mut run = run(plant.at_rest(), &Options::default());
    assert_eq!((run.taken.len(), run.networks().count()), (88, 4));
    agrees("commands", &run);
    // The control: a command that moved the hand, taken a tick early or late, is another run.
    let moved = |n: &usize| {
        matches!(run.taken[*n].1.message, Down::Drive { .. }) && run.answers[*n].1 == Answer::Done
    };
    let moved = (0..run.taken.len()).rfind(moved).expect("some were carried out");
    for other in [run.taken[moved].0 - 1, run.taken[moved].0 + 1] {
        let own = std::mem::replace(&mut run.taken[moved].0, other);
        assert!(!Agreement::of(&run).holds(), "{other} instead of {own}");
        run.taken[moved].0 = own;
    }
}

// Shows B8.
#[test]
fn a_tick_costs_less_than_a_fifth_of_the_core() {
    let run = plain();
    let cost = run.tick_cost.expect("ticks were counted");
    // 0.5 ms at 100 MHz are 50 000 cycles; three cycles an instruction at worst.
    assert!(cost.instructions_mean > 100.0, "{cost:?}");
    // Of each frame, the first one's included; the board's own count is told ten times a second and is older.
    assert!((20_000..=20_016).contains(&cost.count), "{cost:?}");
    assert!(3.0 * cost.instructions_mean < 10_000.0, "{cost:?}");
    assert!(
        3 * cost.instructions_max < 50_000,
        "the dearest tick ends in its own half millisecond: {cost:?}"
    );
    let stack = run.stack_bytes.expect("the stack was painted");
    assert!((256..32 * 1024).contains(&stack), "{stack} bytes");
}
