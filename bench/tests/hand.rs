//! Hands of several fingertips with a palm on one bus: the scenes, what breaks, and who else speaks.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_bench::bars::Goal;
use tenax_bench::hand::report::{self, Scene};
use tenax_bench::hand::{Options, Outcome, Part, run};
use tenax_bench::session::load_scene;
use tenax_palm::bus::CYCLE_US;
use tenax_palm::palm::Report;
use tenax_scene::SceneFile;
use tenax_scene::builtin::hands;

use crate::common::asked;

/// Seeds on which nothing was chosen.
const SEEDS: std::ops::Range<u64> = 101..104;

fn scene(name: &str) -> SceneFile {
    load_scene(name).unwrap()
}

fn is_quiet(run: &Outcome) -> bool {
    !run.opened && !run.driven
}

#[test]
fn what_fingertips_keep_alone_a_hand_keeps_and_its_bus_keeps_its_bars() {
    // Of few slips a share is told: `TENAX_SEEDS=6` has more of them.
    let seeds = asked("TENAX_SEEDS").unwrap_or(3);
    let scenes: Vec<Scene> =
        hands().iter().map(|(name, _)| report::scene(&scene(name), 101..101 + seeds)).collect();
    let report = report::Report { scenes, cuts: None };
    println!("{report}");
    assert!(report.holds());
    for scene in &report.scenes {
        assert_eq!((scene.kept, scene.broken, scene.missing), (scene.runs, 0, 0), "{}", scene.name);
        assert!(
            scene.messages > 1_000 && scene.cycle_us <= CYCLE_US,
            "{}: {} us",
            scene.name,
            scene.cycle_us
        );
        assert!(scene.clock_us > 0.0 && scene.clock_us <= 100.0, "{}: {} us", scene.name, scene.clock_us);
        let (known, truth) = (Goal::of("hand-force"), Goal::of("hand-force-true"));
        assert!(known.holds(scene.over_known) && truth.holds(scene.over_true), "{}", scene.name);
        // A palm costs no force.
        assert!(scene.over_known <= scene.over_known_alone.max(known.goal) + 0.02, "{}", scene.name);
    }
    let told_ms = report.scenes.iter().filter_map(|scene| scene.evidence_ms).map(|[_, most]| most);
    assert!(told_ms.clone().count() >= 2 && told_ms.fold(0.0, f64::max) <= 25.0);
    let slips: usize = report.scenes.iter().map(|scene| scene.slips).sum();
    let untold: u32 = report.scenes.iter().map(|scene| scene.untold).sum();
    assert!(untold as usize * 10 <= slips, "{untold} of {slips} slips were not told");
}

#[test]
fn the_scenes_need_their_reflexes() {
    for (name, _) in hands() {
        let control = Options { reflex: false, ..Options::default() };
        let control = run(&scene(name), &control, None);
        println!("{name}: {} {:.1} mm", control.dropped, control.slid_mm);
        assert_eq!(control.pulses, 0);
        assert!(control.dropped, "{name}");
    }
}

#[test]
fn whatever_breaks_nothing_is_dropped_that_the_rest_holds_and_the_loss_is_told() {
    let files: Vec<SceneFile> = hands().iter().map(|(name, _)| scene(name)).collect();
    let cuts = report::cuts(&files, 12);
    println!("{cuts:?}");
    assert_eq!((cuts.runs, cuts.lost, cuts.broken, cuts.untold), (12, 0, 0, 0));
    assert!(cuts.told_ms > 0.0 && cuts.told_ms <= 100.0, "{} ms", cuts.told_ms);
}

/// Until after the lift, with somebody else on the bus from the start of the grip on.
fn invaded(seed: u64, palm: bool, speaks: &mut dyn FnMut(&mut ChaCha8Rng) -> Vec<u8>) -> Outcome {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut intruder = |t_s: f64| if t_s < 0.5 { Vec::new() } else { speaks(&mut random) };
    run(&scene("ice"), &Options { seed, palm, until_s: 6.5, ..Options::default() }, Some(&mut intruder))
}

#[test]
fn a_flood_moves_nothing_that_does_not_move_without_it_and_is_told() {
    let mut flood =
        |random: &mut ChaCha8Rng| (0..random.random_range(1..90)).map(|_| random.random::<u8>()).collect();
    for seed in SEEDS {
        let (with, alone) = (invaded(seed, true, &mut flood), invaded(seed, false, &mut |_| Vec::new()));
        assert!(is_quiet(&with) && !with.dropped);
        // Every finger is on its own: bit for bit what it is without a palm and a bus.
        assert_eq!((with.end_n, with.pulses), (alone.end_n, alone.pulses), "seed {seed}");
        let lost_s =
            with.reports.iter().find(|(_, report)| *report == Report::BusLost).map(|(at_s, _)| at_s - 0.5);
        println!("seed {seed}: {lost_s:?}");
        assert!(lost_s.is_some_and(|s| s <= 0.1), "seed {seed}: {:?}", with.reports);
    }
}

#[test]
fn two_fingers_with_one_address_are_told_apart_again() {
    for (n, seed) in SEEDS.enumerate() {
        let at_s = 5.2;
        let cut = Some((at_s, Part::Twin(n, n + 1)));
        let run = run(&scene("bottle"), &Options { seed, cut, until_s: 7.0, ..Options::default() }, None);
        println!("seed {seed}: {:?}", run.reports);
        assert!(is_quiet(&run) && !run.dropped);
        let since = |wanted: &dyn Fn(&Report) -> bool| {
            run.reports
                .iter()
                .filter(|(told_s, report)| *told_s >= at_s && wanted(report))
                .map(|(told_s, _)| told_s - at_s)
                .collect::<Vec<_>>()
        };
        let (lost, found) = (
            since(&|report| matches!(report, Report::Lost(_))),
            since(&|report| matches!(report, Report::Found(_))),
        );
        assert!(lost.len() == 2 && found.len() == 2, "seed {seed}");
        assert!(lost.iter().all(|&s| s <= 0.1) && found.iter().all(|&s| s <= 0.2), "seed {seed}");
    }
}

#[test]
fn the_same_seed_gives_the_same_hand() {
    let forces = || run(&scene("pinch"), &Options { until_s: 6.0, ..Options::default() }, None).end_n;
    assert_eq!(forces(), forces());
}

#[test]
fn in_a_minute_of_five_fingers_no_message_of_their_lines_is_lost() {
    let text = "name = \"minute\"\nbase = \"bottle\"\ntitle = \"A bottle for a minute\"\nduration_s = 60";
    let run =
        run(&SceneFile::parse(text, "minute").unwrap(), &Options { seed: 104, ..Options::default() }, None);
    let messages: Vec<u64> = run.lines.iter().map(|line| line.messages).collect();
    println!("{messages:?}, cycle {} us, {} cycles, clock {} us", run.cycle_us, run.cycles, run.clock_us);
    assert!(messages.iter().all(|&messages| messages > 60 * 80), "80 slow frames a second");
    assert!(run.line_dropped == 0 && run.lines.iter().all(|line| line.missed + line.bad_frames == 0));
    assert!(run.cycle_us <= CYCLE_US && run.cycles >= 29_990 && run.clock_us <= 100.0);
    assert!(is_quiet(&run) && !run.dropped && run.reports.len() == 5, "{:?}", run.reports);
}

#[test]
fn a_finger_that_starts_anew_is_found_again_beside_four_others() {
    let cut = Some((5.2, Part::Restart(2)));
    let run = run(&scene("bottle"), &Options { seed: 105, cut, until_s: 6.0, ..Options::default() }, None);
    let told: Vec<_> = run.reports.iter().filter(|(at_s, _)| *at_s >= 5.2).collect();
    println!("{told:?}, cycle {} us", run.cycle_us);
    let [(lost_s, Report::Lost(3)), (found_s, Report::Found(3))] = told[..] else { panic!("{told:?}") };
    assert!(*lost_s < 5.3 && *found_s < 5.4 && run.cycle_us <= CYCLE_US && is_quiet(&run));
}
