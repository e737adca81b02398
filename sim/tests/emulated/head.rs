//! A board that feels with a photoelastic head alone.

use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::wire::Slow;
use tenax_scene::World;
use tenax_sim::board::agreement::Agreement;
use tenax_sim::board::emulated::Options;
use tenax_sim::session;

use crate::run;

/// That the block is kept is `studies/tests/all/photoelastic.rs`; here the image does what the host does.
#[test]
fn the_image_answers_a_pulled_block_with_it_as_the_host_would() {
    let file = session::load_scene("head-alone").unwrap();
    let run = run(World::new(&file, 1), &Options::default());
    let agreement = Agreement::of(&run);
    assert!(agreement.holds(), "{agreement}");
    let acts = |slow: &Slow| slow.ticks.iter().any(|tick| tick.acted.contains(DetectorId::Photoelastic));
    assert!(run.slows.iter().any(acts), "the head's pulse");
    let stood_in = run.slows.iter().filter(|slow| slow.forces.is_some()).count();
    assert!(stood_in > run.slows.len() * 3 / 4, "{stood_in} of {}", run.slows.len());
}
