//! The vibration motor's pin on the real image: `bench/tests/feedback.rs` says when it is driven, and that the films do not mind.

use tenax_hal_shim::motor::Duty;
use tenax_scene::{SceneFile, World};
use tenax_sim::board::agreement::Agreement;
use tenax_sim::board::emulated::{self, Mishap, Options};
use tenax_sim::board::{Run, simulated};

use crate::image;

/// The gripper takes a block: the board tells of force, then of slip.
fn world() -> World {
    let text = "name = 'vibrates'\ntitle = 'V'\nbase = 'gripper'\nduration_s = 3\n\
        [vibrator]\nfilm_mv = 3\nfull_hz = 200\nspin_ms = 40\n\
        [[command]]\nat_s = 0.11\nkind = 'set-feedback-choice'\nvalue = 1\n";
    World::new(&SceneFile::parse(text, "vibrates").expect("a scene"), 1)
}

fn ran(mishaps: Vec<(f64, Mishap)>) -> Run {
    let options = Options { mishaps, ..Options::default() };
    emulated::run(image(), world(), &options, &mut |_| {}).expect("it runs").0
}

// Shows B8.
#[test]
fn the_image_drives_it_bit_for_bit_as_the_hosts_logic() {
    let run = ran(Vec::new());
    let agreement = Agreement::of(&run);
    println!("{agreement}");
    assert!(agreement.holds(), "{agreement}");
    assert_eq!((run.counters.ticks_late, run.counters.frames_lost, run.bad_frames), (0, 0, 0));
    assert!(run.feedback.len() >= 4 && run.feedback.last().is_some_and(|last| last.1 == Duty::default()));
}

// Shows B1.
#[test]
fn a_hung_core_and_a_panic_end_it() {
    let (host, _) = simulated::run(world(), &mut |_| {});
    let at_s = |frame: u32| f64::from(frame) / 2_000.0;
    let began_s = at_s(host.feedback[0].0);
    for (mishap, within_s) in [(Mishap::CoreHangs, 0.15), (Mishap::DmaFails, 0.03)] {
        let run = ran(vec![(began_s + 0.02, mishap.clone())]);
        println!("{mishap:?} at {:.3} s: {:?}", began_s + 0.02, run.feedback);
        let [on, off] = [run.feedback[0], run.feedback[1]];
        assert!(on.1 > Duty::default() && at_s(on.0) < began_s + 0.01, "it was driven before");
        assert_eq!(off.1, Duty::default());
        // To the frame.
        assert!((-0.001..within_s).contains(&(at_s(off.0) - began_s - 0.02)), "{mishap:?}");
    }
}
