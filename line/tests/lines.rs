//! Lines and files that are no board's, or are in use: what the commands say.

use std::fs;
use std::io::{Cursor, ErrorKind, Read};
use std::process::Stdio;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use serialport::{SerialPort, TTYPort};
use tenax_frames::link::{Client, Counts, Line};
use tenax_hal_shim::wire::{Counters, FRAME_MAX, Up, encode};
use tenax_line::cli::monitor;

use crate::serving::{command, tenax};

fn frame(sequence: u16, message: &Up) -> Vec<u8> {
    encode(sequence, message, &mut [0; FRAME_MAX]).expect("it fits").to_vec()
}

fn counters(sequence: u16) -> Vec<u8> {
    let frames = u32::from(sequence);
    frame(sequence, &Up::Counters(Counters { frames, ..Counters::default() }))
}

#[test]
fn gaps_and_random_bytes_are_named_and_survived() {
    let mut noise = vec![0; 1 << 20];
    ChaCha8Rng::seed_from_u64(1).fill(&mut noise[..]);
    // Two are missing over the wrap of the numbers, one after it; a start begins with any number.
    let hello = frame(700, &Up::Hello { frame_hz: 2_000, after: None });
    let sound = [65_534, 1, 2, 4].map(counters).concat();
    let bytes = [&counters(65_533)[5..], &sound, &noise, &[0], &counters(5), &hello].concat();
    let up = Box::new(Cursor::new(bytes));
    let (mut client, mut out) = (Client::from(Line { up, down: None }), Vec::new());
    assert_eq!(monitor::watch(&mut client, &mut out).unwrap().kind(), ErrorKind::UnexpectedEof);
    let Counts { messages, bad_frames, missed } = client.counts();
    assert_eq!((messages, missed), (6, 3), "a CRC-32 lets one in four billion through");
    assert!(bad_frames > 3_000, "{bad_frames}");
    let text = String::from_utf8(out).unwrap();
    assert!(text.contains("    2 Counters { frames: 2,"), "{text}");
    assert!(text.contains("# 1 messages missed\n    4 Counters"), "said where they are missing: {text}");
}

#[test]
fn what_is_no_boards_line_is_neither_played_nor_watched() {
    let folder = tempfile::tempdir().unwrap();
    let (empty, random) = (folder.path().join("empty.bin"), folder.path().join("random.bin"));
    fs::write(&empty, "").unwrap();
    let mut bytes = vec![0; 100_000];
    ChaCha8Rng::seed_from_u64(2).fill(&mut bytes[..]);
    fs::write(&random, bytes).unwrap();
    for file in [empty, random] {
        for args in [&["play", "--csv", "out"][..], &["monitor", "--file"], &["monitor", "--plain", "--file"]]
        {
            let (done, _, said) = tenax(&[args, &[file.to_str().unwrap()]].concat());
            assert!(
                !done && said.contains("is no board's line") && said.contains("tenax record"),
                "{args:?}: {said}"
            );
        }
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_port_that_another_program_reads_names_it() {
    let (_near, far) = TTYPort::pair().unwrap();
    let path = far.name().unwrap();
    // Or this program would be the one that is named.
    drop(far);
    let mut other = std::process::Command::new("sh")
        .args(["-c", &format!("exec 3<{path}; echo; exec sleep 60")])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    other.stdout.take().unwrap().read_exact(&mut [0]).unwrap();
    let (done, _, said) = tenax(&["monitor", "--plain", "--port", &path]);
    other.kill().unwrap();
    other.wait().unwrap();
    assert!(
        !done && said.contains(&format!("another program reads {path}: process {} (s", other.id())),
        "{said}"
    );
}

/// As `tenax tables wire | head -1`.
#[test]
fn an_output_that_nobody_reads_is_no_error() {
    let mut child =
        command(&["tables", "wire"]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    child.stdout.take().unwrap().read_exact(&mut [0]).unwrap();
    let done = child.wait_with_output().unwrap();
    assert!(done.status.success() && done.stderr.is_empty(), "{done:?}");
}
