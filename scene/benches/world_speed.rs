//! What a world costs: `cargo bench -p tenax-scene`. How much faster than real time it is, which depends on the machine and
//! on what else that does; and, where valgrind is installed, how many instructions it takes, which do not.
//!
//! The bar is at most 40 million instructions a virtual second of `pick-up`; at 200 times real time that leaves an idle core
//! 8000 million a second.

use std::process::{Command, ExitCode};
use std::time::Instant;

use tenax_hal_shim::motor::MotorDrive;
use tenax_scene::plant::Plant;
use tenax_scene::{SceneFile, World, builtin};

const SCENES: [&str; 2] = ["pick-up", "glass"];
const BAR_M_PER_S: f64 = 40.0;
/// Told by this program to itself, with a scene's name and the part of it to run: run it, and nothing else.
const ONLY: &str = "--only";

fn scene(name: &str) -> SceneFile {
    let (_, text) = builtin().iter().find(|(known, _)| *known == name).expect("a scene of the repository");
    SceneFile::parse(text, name).expect("the repository's scenes parse")
}

fn run(scene: &SceneFile, virtual_s: f64) {
    let mut world = World::new(scene, 1);
    for _ in 0..(virtual_s * 8e3) as u64 {
        std::hint::black_box(world.scan(MotorDrive::Coast).codes());
    }
}

fn times_real_time(scene: &SceneFile) -> f64 {
    let began = Instant::now();
    run(scene, scene.duration_s());
    scene.duration_s() / began.elapsed().as_secs_f64()
}

/// Million instructions a virtual second, what it takes to begin not among them. None where nobody can count them.
fn instructions_m_per_s(name: &str, duration_s: f64) -> Option<f64> {
    let count = |virtual_s: f64| {
        let counted = Command::new("valgrind")
            .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
            .arg(std::env::current_exe().ok()?)
            .args([ONLY, name, &virtual_s.to_string()])
            .output()
            .ok()
            .filter(|output| output.status.success())?;
        let said = String::from_utf8_lossy(&counted.stderr).into_owned();
        let (_, count) = said.split_once("Collected :")?;
        count.split_whitespace().next()?.parse::<f64>().ok()
    };
    Some((count(duration_s)? - count(0.0)?) / duration_s / 1e6)
}

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    if let [only, name, virtual_s] = args.as_slice()
        && only == ONLY
    {
        run(&scene(name), virtual_s.parse().expect("a number"));
        return ExitCode::SUCCESS;
    }
    let mut kept = true;
    for name in SCENES {
        let scene = scene(name);
        // The best of five: whatever else the machine does can only slow it.
        let best = (0..5).map(|_| times_real_time(&scene)).fold(0.0, f64::max);
        let counted = match instructions_m_per_s(name, scene.duration_s()) {
            Some(million) => {
                kept &= name != SCENES[0] || million <= BAR_M_PER_S;
                format!("{million:.1} million instructions a virtual second")
            }
            None => "instructions not counted: valgrind does not run".to_owned(),
        };
        println!("{name}: {best:.0} times real time, {counted}");
    }
    if kept { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
