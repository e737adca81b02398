//! The behaviours in their scenes, each of the paper's results beside its control, with a camera that errs as the vision crate does and
//! with one of whose pictures 5 % are wrong, three in a row. Sixteen seeds each: of eight, one in twenty is too often two.
//! `TENAX_SEEDS=100 cargo test ... --test all behaviours` runs more.

use crate::common::{asked, parsed, text};
use tenax_scene::{Truth, World};
use tenax_sim::session::Board;

fn seeds() -> std::ops::RangeInclusive<u64> {
    1..=asked("TENAX_SEEDS").unwrap_or(16)
}

fn fates(name: &str, more: &str) -> Vec<Truth> {
    run(&format!("{}\n{more}", text(name)))
}

fn run(text: &str) -> Vec<Truth> {
    let scene = parsed(text);
    let run =
        |seed| Board::Host.run(World::new(&scene, seed), &mut |_| {}).expect("it runs").1.truth().clone();
    seeds().map(run).collect()
}

const BURSTS: &str = "[skin]\nwrong_part = 0.05\nwrong_pictures = 3";

/// With the camera's own errors nothing is lost or crushed. With bursts nothing is lost, and at most one seed in eight is crushed; the
/// goal is none.
fn unharmed(name: &str) -> Vec<Truth> {
    let crushed = |more: &str| {
        let fates = fates(name, more);
        for (seed, truth) in seeds().zip(&fates) {
            let lost = truth.dropped || truth.left_behind || truth.broken_at_s.is_some();
            assert!(!lost, "{name}, seed {seed}, {more}: {:?}", truth.broken_at_s);
        }
        let crushed = fates.iter().filter(|truth| truth.dent_mm > 0.0).count();
        (fates, crushed)
    };
    let (of_bursts, of_them) = crushed(BURSTS);
    assert!(8 * of_them <= of_bursts.len(), "{name}: {of_them} crushed in bursts");
    let (fates, of_them) = crushed("");
    assert_eq!(of_them, 0, "{name}: crushed");
    fates
}

/// A control fails: the object is lost, crushed, or slides by 5 mm, in at least half of the seeds.
fn fails(name: &str, fates: &[Truth]) {
    let fail = |truth: &&Truth| truth.dropped || truth.dent_mm > 0.0 || truth.slip_distance_mm > 5.0;
    let failed = fates.iter().filter(fail).count();
    assert!(2 * failed >= fates.len(), "{name}: the control fails in {failed} of {} only", fates.len());
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (count, sum) = values.fold((0.0, 0.0), |(count, sum), value| (count + 1.0, sum + value));
    sum / count
}

fn slid_mm(fates: &[Truth]) -> f64 {
    mean(fates.iter().map(|truth| truth.slip_distance_mm))
}

#[test]
fn a_can_and_a_card_are_taken_and_none_is_crushed() {
    // The control: fingers that come as far without feeling anything.
    let blind = "[[command]]\nat_s = 2.0\nkind = \"close\"\nduty_permille = 100\nfor_s = 0.7\n";
    for name in ["gentle-can", "gentle-card"] {
        unharmed(name);
        fails(name, &fates(name, blind));
    }
}

/// The reflex acts on no detector.
const MUTED: &str = "\n[[command]]\nat_s = 0.1\nkind = \"set-detectors-off-mask\"\nvalue = 31\n";

#[test]
fn what_is_soft_is_held_against_a_pull_and_a_swing() {
    for name in ["hold-crane", "hold-marshmallow", "hold-toy"] {
        let held = unharmed(name);
        assert!(name != "hold-crane" || slid_mm(&held) < 0.5, "{} mm", slid_mm(&held));
        // The control: nobody holds, the reflex neither.
        let nobody = text(name).replace("kind = \"hold\"", "kind = \"end\"");
        fails(name, &run(&format!("{nobody}{MUTED}")));
    }
}

#[test]
fn holding_slips_less_than_a_gentle_grasp() {
    let (gentle, held) = (fates("push-gentle", ""), unharmed("push-hold"));
    assert!(slid_mm(&held) < 0.5 * slid_mm(&gentle), "{} mm of {}", slid_mm(&held), slid_mm(&gentle));
    fails("push-gentle", &gentle);
}

#[test]
fn water_is_poured_into_a_cup_that_stays_where_it_is() {
    // The control: nobody holds it, and the reflex acts on no detector.
    let nobody = format!("{MUTED}[[command]]\nat_s = 4.2\nkind = \"end\"\n");
    let (ours, theirs) = (unharmed("fill-cup"), fates("fill-cup", &nobody));
    assert!(slid_mm(&ours) < 0.2 * slid_mm(&theirs), "{} mm of {}", slid_mm(&ours), slid_mm(&theirs));
    fails("fill-cup", &theirs);
}

#[test]
fn a_pull_takes_the_object_and_without_one_it_stays() {
    for name in ["hand-over-can", "hand-over-card"] {
        for (seed, truth) in seeds().zip(unharmed(name)) {
            assert!(truth.handed_over, "{name}, seed {seed}: nobody can take it");
        }
    }
    let nobody = run(&text("hand-over-can").replace("force_n = 2.0", "force_n = 0.0"));
    for (seed, truth) in seeds().zip(nobody) {
        assert!(!truth.handed_over && !truth.dropped, "seed {seed}");
    }
}

/// FingerVision 2017, figure 19: in most runs the angle was exceeded. With foresight it is not.
#[test]
fn a_turn_comes_within_two_degrees_and_foresight_takes_the_overshoot_away() {
    let paper = "[[command]]\nat_s = 0.2\nkind = \"set-turn-lead-ms\"\nvalue = 0\n";
    let error_deg = |truth: &Truth| truth.turned_rad.to_degrees() - 20.0;
    let off_deg = |fates: &[Truth]| mean(fates.iter().map(|truth| error_deg(truth).abs()));
    let (ours, papers) = (unharmed("turn-pen"), fates("turn-pen", paper));
    for fates in [&ours, &fates("turn-pen", BURSTS)] {
        assert!(off_deg(fates) <= 2.0, "{} degrees", off_deg(fates));
    }
    let over = |fates: &[Truth]| fates.iter().filter(|truth| error_deg(truth) > 0.0).count();
    assert!(2 * over(&papers) >= papers.len() && over(&ours) < over(&papers));
    let (ours, papers) = (mean(ours.iter().map(error_deg)), mean(papers.iter().map(error_deg)));
    assert!(papers > 0.0 && ours < papers, "{ours}, {papers}");
}
