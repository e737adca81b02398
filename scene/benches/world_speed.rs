//! How many times faster than real time a world runs: `cargo bench -p tenax-scene`. Nothing is judged by it.

use std::time::Instant;

use tenax_hal_shim::motor::MotorDrive;
use tenax_scene::plant::Plant;
use tenax_scene::{SceneFile, World, builtin};

/// Runs a scene under a controller that does nothing; virtual seconds a second of one core.
fn times_real_time(scene: &SceneFile) -> f64 {
    let mut world = World::new(scene, 1);
    let began = Instant::now();
    for _ in 0..(scene.duration_s() * 8e3) as u64 {
        std::hint::black_box(world.scan(MotorDrive::Coast).codes());
    }
    scene.duration_s() / began.elapsed().as_secs_f64()
}

fn main() {
    for (name, text) in builtin().iter().filter(|(name, _)| ["pick-up", "glass"].contains(name)) {
        let scene = SceneFile::parse(text, name).expect("the repository's scenes parse");
        // The best of five: whatever else the machine does can only slow it.
        let best = (0..5).map(|_| times_real_time(&scene)).fold(0.0, f64::max);
        println!("{name}: {best:.0} times real time");
    }
}
