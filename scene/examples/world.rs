//! A scene without a fingertip: a robot strokes a surface, nobody drives the hand, and the truth says when it slid.
//!
//! `cargo run -p tenax-scene --example world -- explore-glass`

use std::error::Error;

use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::motor::MotorDrive;
use tenax_scene::plant::Plant;
use tenax_scene::{SceneFile, World, builtin};

fn main() -> Result<(), Box<dyn Error>> {
    let asked = std::env::args().nth(1).unwrap_or_else(|| "explore-wood".to_owned());
    let (name, text) = builtin().iter().find(|(name, _)| *name == asked).ok_or("no scene has this name")?;
    let scene = SceneFile::parse(text, name)?;
    let mut world = World::new(&scene, 1);
    for _ in 0..(scene.duration_s() * f64::from(SCAN_HZ)) as u64 {
        world.scan(MotorDrive::Coast);
    }
    let truth = world.truth();
    println!("{}: {}", scene.name, scene.title);
    for slip in &truth.slips {
        println!("  slips from {:.4} s on, all of it from {:.4} s", slip.micro_onset_s, slip.macro_onset_s);
    }
    println!("  slid {:.2} mm, {}", truth.slip_distance_mm, if truth.dropped { "dropped" } else { "kept" });
    Ok(())
}
