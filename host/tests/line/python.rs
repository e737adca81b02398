//! The Python package reads a served board: the proof that `docs/protocol.md` is enough.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::serving::Serving;

fn package() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().join("python")
}

/// python3 with the package; None where there is no Python.
fn python() -> Option<Command> {
    let there = Command::new("python3").arg("--version").stdout(Stdio::null()).status();
    if !there.is_ok_and(|status| status.success()) {
        println!("skipped: there is no python3");
        return None;
    }
    let mut python = Command::new("python3");
    python.env("PYTHONPATH", package()).env("PYTHONDONTWRITEBYTECODE", "1");
    Some(python)
}

#[test]
fn every_golden_frame_is_decoded() {
    let Some(mut python) = python() else { return };
    let ran =
        python.args(["-m", "unittest", "discover", "-s", "tests"]).current_dir(package()).output().unwrap();
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
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
    print(sum(kinds.values()))
";

#[test]
fn it_reads_sets_and_streams_a_served_board() {
    let Some(mut python) = python() else { return };
    let served = Serving::trusting();
    let visit = python.args(["-c", VISIT, &served.places[0]]).output().unwrap();
    assert!(visit.status.success(), "{}", String::from_utf8_lossy(&visit.stderr));
    served.end();
}
