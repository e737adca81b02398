//! The behaviours of the real image, in closed loop with their scenes.

use tenax::board::agreement::Agreement;
use tenax::board::emulated::{self, Options};
use tenax::session;
use tenax_hal_shim::behaviour::Ending;
use tenax_hal_shim::wire::EventKind;
use tenax_scene::World;

use crate::image;

fn runs(name: &str) {
    let file = session::load_scene(name).expect("a scene");
    let world = World::new(&file, 1);
    let (run, world) = emulated::run(image(), world, &Options::default(), &mut |_| {}).expect("it runs");
    let agreement = Agreement::of(&run);
    assert!(agreement.holds(), "{name}: {agreement}");
    assert_eq!((run.counters.ticks_late, run.counters.frames_lost, run.bad_frames), (0, 0, 0), "{name}");
    let ended = |event: &&tenax_hal_shim::wire::Event| {
        matches!(event.kind, EventKind::Behaviour(_, Some(Ending::Done)))
    };
    assert!(run.events.iter().any(|event| ended(&event)), "{name}: a behaviour did what it was asked for");
    let truth = world.truth();
    assert!(!truth.dropped && !truth.left_behind && truth.dent_mm == 0.0, "{name}");
}

#[test]
fn a_can_is_handed_over() {
    runs("hand-over-can");
}

#[test]
fn a_pen_is_turned() {
    runs("turn-pen");
}
