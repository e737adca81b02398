//! The image takes every code right and decides what the host's own build of the logic decides.

use std::collections::BTreeMap;
use std::num::NonZeroU64;

use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{Answer, Down, Setting};
use tenax_hal_shim::words::Code;
use tenax_logic::setting::SettingId;
use tenax_scene::World;
use tenax_sim::board::agreement::Agreement;
use tenax_sim::board::emulated::Options;
use tenax_sim::board::simulated;
use tenax_sim::session;

use crate::hash::{compare, of_run};
use crate::onsets::held_against_evidence;
use crate::{Rest, Swing, plain, run};

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
    let agreement = Agreement::of(run);
    assert!(agreement.holds(), "{agreement}");
    let onsets = held_against_evidence(&run.slows);
    assert!(onsets.iter().any(|frames| !frames.is_empty()), "a detector has spoken");
}

/// The default scene's line of the golden gate (`bench/tests/golden.rs`) on the emulated board.
#[test]
fn the_default_scene_decides_as_held() {
    let file = session::load_scene(session::DEFAULT_SCENE).expect("a shipped scene is good");
    let hash = of_run(&run(World::new(&file, 1), &Options::default()));
    compare("emulated", &BTreeMap::from([(format!("{} 1", session::DEFAULT_SCENE), hash)]));
}

/// The check above can fail: one code off by one is another CRC.
// Shows B8.
#[test]
fn one_wrong_code_is_noticed() {
    let mut run = plain().clone();
    assert!(Agreement::of(&run).holds());
    run.scans[250][3] ^= 1;
    assert!(!Agreement::of(&run).holds());
}

#[test]
fn the_simulated_board_keeps_the_images_time() {
    let image = plain();
    let (host, _) = simulated::run(Swing::new(image.virtual_s), &mut |_| {});
    assert!(host.scans == image.scans);
    assert_eq!(host.drives, image.drives);
    assert_eq!(host.slows, image.slows);
    assert_eq!(host.events, image.events);
}

/// From two cycles an instruction to one: the same codes, the same decisions, and what is late harms nothing.
// Shows B7, B8.
#[test]
fn decisions_are_the_same_at_50_67_and_100_million_instructions_a_second() {
    let runs = [50, 67, 100].map(|millions: u64| {
        let instructions_per_second = NonZeroU64::new(millions * 1_000_000).expect("not zero");
        let run = run(Swing::new(2.0), &Options { instructions_per_second, ..Options::default() });
        let (counters, cost) = (run.counters, run.tick_cost.expect("ticks were counted"));
        println!(
            "{millions} M: {} of {} ticks late, longest {} us, {cost:?}",
            counters.ticks_late, counters.ticks, counters.control_us_max
        );
        assert_eq!((counters.overruns, counters.frames_lost), (0, 0), "{millions} M");
        assert_eq!((counters.telemetry_dropped, run.messages_missed), (0, 0), "{millions} M");
        assert!(Agreement::of(&run).holds(), "{millions} M");
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

/// Commands sent at every scan of a frame, and some at once: a late one is taken a tick later, and the host's logic says
/// the same if it is given each of them where the image took it.
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
    let mut run = run(Rest::new(plant), &Options::default());
    assert_eq!((run.taken.len(), run.networks().count()), (88, 4));
    let agreement = Agreement::of(&run);
    assert!(agreement.holds(), "{agreement}");
    // One of them a tick early or late is another run: one that moved the hand, for the muscles refuse others.
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
