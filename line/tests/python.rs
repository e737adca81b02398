//! The Python package reads a served board: `docs/protocol.md` is enough for a client.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::recording::line;
use crate::serving::trusting;

fn package() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().join("python")
}

fn python() -> Command {
    let mut python = Command::new(std::env::var_os("TENAX_PYTHON").unwrap_or_else(|| "python3".into()));
    python.env("PYTHONPATH", package()).env("PYTHONDONTWRITEBYTECODE", "1");
    python
}

const VISIT: &str = r"
import sys
import tenax

with tenax.open(sys.argv[1]) as board:
    about = board.ask('About')
    assert about.kind == 'About' and about.identity.build == 0 and len(about.settings) > 20, about
    answer = board.ask('Set', 1, 120)
    assert (answer.kind, answer.value) == ('Setting', 120), answer
    refused = board.ask('Set', 1, 5)
    assert (refused.refusal.kind, refused.refusal.min) == ('OutOfRange', 20), refused
    board.stream(raw=True, senses=True)
    kinds, frames = {}, []
    for message in board:
        kinds[message.kind] = kinds.get(message.kind, 0) + 1
        if message.kind == 'Raw':
            frames.append(message.first)
        if len(frames) == 400:
            break
    assert frames == list(range(frames[0], frames[0] + 2000, 5)), 'a frame is missing'
    assert 78 <= kinds['Slow'] <= 82 and 78 <= kinds['Senses'] <= 82, kinds
    assert (board.missed, board.bad) == (0, 0), (board.missed, board.bad)
";

#[test]
#[cfg_attr(not(python), ignore = "no python3 here")]
fn it_reads_sets_and_streams_a_served_board() {
    let served = trusting();
    let visit = python().args(["-c", VISIT, &served.place]).output().unwrap();
    assert!(visit.status.success(), "{}", String::from_utf8_lossy(&visit.stderr));
    served.end();
}

#[test]
#[cfg_attr(not(python), ignore = "no python3 here")]
fn the_example_runs_live_and_offline() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("glass.line.bin");
    std::fs::write(&file, line("glass", false)).unwrap();
    let served = trusting();
    let ran = python()
        .arg(package().join("example.py"))
        .arg(&served.place)
        .arg(&file)
        .current_dir(&folder)
        .output()
        .unwrap();
    let (said, error) = (String::from_utf8_lossy(&ran.stdout), String::from_utf8_lossy(&ran.stderr));
    assert!(ran.status.success(), "{said}{error}");
    assert!(said.contains("image 0000000000000000") && said.contains("0 missed, 0 bad"), "{said}");
    let file = file.to_str().unwrap();
    let says = |words: &str| said.lines().any(|line| line.starts_with(file) && line.contains(words));
    assert!(says("4800 slow frames, 120000 ticks") || says("4799 slow frames, 119975 ticks"), "{said}");
    assert!(says("s on S1") && says("s on S2"), "{said}");
    served.end();
}
