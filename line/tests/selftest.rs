//! `tenax selftest` on a served board: its prompts are piped to the bench, where they are done.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use crate::serving::Serving;

/// Two wires exchanged, and a third cut.
pub const FAULTS: &str = "
[[fault]]
at_s = 0
channel = \"array_2\"
kind = \"swapped\"
with = \"array_3\"
reason = \"a test\"
[[fault]]
at_s = 0
channel = \"fsr_b\"
kind = \"dead\"
reason = \"a test\"
";

/// Runs the command on the bench with these faults; whether all pass, and all that it said.
fn selftest(faults: &str, channels: &[&str]) -> (bool, String) {
    let bench = include_str!("../../../scenes/parts/bench.toml");
    let mut served = Serving::start(&format!("{bench}{faults}"), &[]);
    let mut test = Command::new(env!("CARGO_BIN_EXE_tenax-host"))
        .arg("selftest")
        .args(channels)
        .args(["--port", &served.places[0]])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = String::new();
    for line in BufReader::new(test.stdout.take().unwrap()).lines().map(Result::unwrap) {
        served.tell(&line);
        said += &(line + "\n");
    }
    let passes = test.wait().unwrap().success();
    served.kill();
    println!("{said}");
    (passes, said)
}

#[test]
fn exchanged_and_dead_wires_are_named_with_their_inputs() {
    let (passes, said) = selftest(FAULTS, &["pvdf_1", "fsr", "array_2", "array_3", "opening"]);
    assert!(said.contains("array_2 (switch B, 1) and array_3 (switch B, 2): exchange their wires"));
    assert!(said.contains("fsr_b (switch A, 13): 0 mV: a cut wire"));
    assert!(!passes && said.ends_with("5 of 8 channels pass\n"));
}

#[test]
fn a_good_board_passes() {
    let (passes, said) = selftest("", &["strain_1", "fsr_a", "myo"]);
    assert!(passes && said.ends_with("4 of 4 channels pass\n") && !said.contains("FAIL"), "{said}");
}
