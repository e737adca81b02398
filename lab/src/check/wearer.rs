//! The wearer comes first: in every scene, and against random hands.

use std::path::Path;
use std::process::Command;

use tenax_scene::builtin;
use tenax_sim::live::Use;
use tenax_sim::session::{self, Board};

use super::{Bar, Verdict};

const TWO_SLOW_FRAMES_MS: f64 = 25.0;

pub fn scenes() -> anyhow::Result<Vec<Bar>> {
    let (mut while_active, mut elsewhere, mut slowest_ms, mut opened) = (0, 0, 0f64, 0);
    for (name, _) in builtin() {
        let (file, line) = (session::load_scene(name)?, Use { without_bound: true, ..Use::default() });
        let outcome = session::scene_served(&file, 1, &Board::Host, line, &mut (), &mut |_| {})?;
        let wearer = &outcome.report.wearer;
        while_active += wearer.reflex_while_active;
        elsewhere += wearer.reflex_ticks - wearer.reflex_while_active;
        if let Some(latency_ms) = wearer.open_latency_ms {
            slowest_ms = slowest_ms.max(latency_ms);
            opened += 1;
        }
    }
    let count = builtin().len();
    Ok(vec![
        Bar::new(
            "reflex commands while a myosensor is active, every scene",
            format!("{while_active} in {count} scenes, and {elsewhere} ticks of reflex while none is"),
            "none",
            while_active == 0 && elsewhere > 0,
        ),
        Bar::new(
            "an open command takes effect, every scene",
            format!("{slowest_ms:.1} ms at worst in {opened} scenes where the wearer opens"),
            "2 slow frames, 25 ms",
            opened > 0 && slowest_ms <= TWO_SLOW_FRAMES_MS,
        ),
    ])
}

/// The contract against random hands: `wearer.rs` and `adversary.rs` of `host-tests`, run by cargo.
pub fn random(root: &Path) -> Bar {
    const PROMISE: &str =
        "1,000,000 random steps: reflex silent while active, open within 2 slow frames, no fault opens";
    let mut cargo = Command::new("cargo");
    // As `cargo tenax test` compiles it: of one package alone, every crate below it would be compiled once more.
    cargo.args(["test", "--quiet", "--release", "--ignore-rust-version", "--workspace", "--exclude"]);
    cargo.args(["tenax-firmware", "--test", "fingertip", "--", "wearer::", "adversary::"]).current_dir(root);
    let output = match cargo.output() {
        Ok(output) => output,
        Err(error) => {
            return Bar::unjudged(PROMISE, format!("cargo cannot be started: {error}"), Verdict::Skipped);
        }
    };
    let text = String::from_utf8_lossy(&output.stdout);
    let result = text.lines().find_map(|line| line.strip_prefix("test result: "));
    let measured = match result.and_then(|line| line.split(';').next()) {
        Some(line) => format!("host-tests/tests/wearer.rs and adversary.rs: {line}"),
        None => format!("the tests did not run: {}", String::from_utf8_lossy(&output.stderr).trim()),
    };
    Bar::new(PROMISE, measured, "", output.status.success() && result.is_some())
}
