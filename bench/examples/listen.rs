//! A scene, or a recording, on the host's build of the logic: what each detector said, and when. Begin here to measure
//! something of your own.
//!
//! `cargo run --release -p tenax-bench --example listen -- knocks`, or a CSV file in place of the scene's name

use std::path::Path;

use tenax_bench::board::Recorder;
use tenax_bench::session::{self, Board};
use tenax_bench::timeline::Timeline;
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::wire::Slow;

/// Takes what comes up the line, 80 times a virtual second.
struct Listener {
    timeline: Timeline,
    vibration: u16,
}

impl Recorder for Listener {
    fn slow(&mut self, slow: &Slow) {
        self.timeline.slow(slow);
        self.vibration = slow.ticks.iter().map(|tick| tick.vibration).fold(self.vibration, u16::max);
    }
}

fn main() -> anyhow::Result<()> {
    let asked = std::env::args().nth(1).unwrap_or_else(|| session::DEFAULT_SCENE.to_owned());
    let mut listener = Listener { timeline: Timeline::new(0.0), vibration: 0 };
    let outcome = if asked.ends_with(".csv") {
        session::replay_with(Path::new(&asked), None, None, 1, &Board::Host, &mut listener, &mut |_| {})?
    } else {
        let scene = session::load_scene(&asked)?;
        session::scene_with(&scene, 1, &Board::Host, &mut listener, &mut |_| {})?
    };
    println!("{}: the loudest vibration is {} of 16383", outcome.report.scene, listener.vibration);
    for id in DetectorId::ALL {
        println!("{:>9} said so at {:.4?} s", id.name(), listener.timeline.said(id));
    }
    Ok(())
}
