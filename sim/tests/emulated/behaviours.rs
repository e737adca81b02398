//! The behaviours of the real image, in closed loop with their scenes.

use tenax_hal_shim::behaviour::Ending;
use tenax_hal_shim::wire::EventKind;
use tenax_scene::{SceneFile, World, builtin};
use tenax_sim::board::agreement::Agreement;
use tenax_sim::board::emulated::{self, Options};
use tenax_sim::session;

use crate::image;

/// Every scene in which somebody asks for a behaviour by name. Strokes are told to begin and to end.
fn scenes() -> Vec<&'static str> {
    let asks = |(name, text): &&(&str, &str)| {
        let scene = SceneFile::table(text, name).expect("a scene");
        let commands = scene.get("command").and_then(|all| all.as_array()).into_iter().flatten();
        let mut kinds = commands.filter_map(|command| command.get("kind")?.as_str());
        kinds.any(|kind| ["grasp-gently", "hold", "hand-over", "turn"].contains(&kind))
    };
    builtin().iter().filter(asks).map(|(name, _)| *name).collect()
}

/// Runs a scene on the image: every tick as on the host.
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
    // The push in a gentle grasp is a control: its object may be lost.
    assert!(name == "push-gentle" || !truth.dropped && !truth.left_behind, "{name}");
    assert_eq!(truth.dent_mm, 0.0, "{name}");
}

#[test]
fn a_can_is_handed_over() {
    runs("hand-over-can");
}

#[test]
fn a_pen_is_turned() {
    runs("turn-pen");
}

/// Of all scenes this one asks the most of a tick.
#[test]
fn a_push_is_held() {
    runs("push-hold");
}

#[test]
#[ignore = "a minute, the heaviest three run by themselves: `cargo test ... --test emulated behaviours -- --ignored`"]
fn every_behaviour_of_the_image_is_that_of_the_host() {
    let scenes = scenes();
    assert!(scenes.len() >= 11 && scenes.contains(&"turn-pen"), "{scenes:?}");
    for name in scenes {
        let began = std::time::Instant::now();
        runs(name);
        println!("{name}: as on the host, {:.0} s", began.elapsed().as_secs_f64());
    }
}
