//! Recordings: what is in them is what was on the line, and decides the same once more.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

use tenax_frames::link::captured::line_of;
use tenax_frames::record::Recording;
use tenax_scene::World;
use tenax_sim::again::Recorded;
use tenax_sim::live::Use;
use tenax_sim::session::{Board, load_scene};

use crate::serving::{BENCH, Serving, command, tenax, trusting};

pub fn line(scene: &str, streams_at_start: bool) -> Vec<u8> {
    let plant = Use { streams_at_start, ..Use::default() }.of(World::new(&load_scene(scene).unwrap(), 1));
    Board::Host.run(plant, &mut |_| {}).unwrap().0.line
}

pub fn record(path: &Path, line: &[u8]) {
    let mut recording = Recording::create(path).unwrap();
    recording.line(line).unwrap();
    recording.finish().unwrap();
}

#[test]
fn a_recording_decides_the_same_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.mcap");
    let line = line("pick-up-reflex", true);
    record(&path, &line);
    let recorded = line_of(&path).unwrap();
    // The zero that ends whatever a reset cut short is no message.
    assert!(recorded == line[1..], "the bytes are those of the line");
    let outcome = Recorded::of(&recorded).unwrap().replay();
    assert_eq!(outcome.difference, None);
    assert!(outcome.frames >= 11_990 && outcome.slows >= 479 && outcome.events > 5, "{outcome:?}");

    // Torn, or cut short, it is no panic.
    let cut = folder.path().join("cut.mcap");
    let bytes = std::fs::read(&path).unwrap();
    for length in [0, 1, 7, 8, 100, bytes.len() - 1] {
        std::fs::write(&cut, &bytes[..length]).unwrap();
        let _short = line_of(&cut);
    }
    // Of another compression, as of other recorders.
    let at = bytes.windows(4).position(|part| part == b"zstd").unwrap();
    std::fs::write(&cut, [&bytes[..at], b"lz4_", &bytes[at + 4..]].concat()).unwrap();
    assert!(format!("{:#}", line_of(&cut).unwrap_err()).contains("`mcap decompress "));
    let mut torn = bytes;
    torn.iter_mut().skip(8).step_by(997).for_each(|byte| *byte ^= 0x55);
    std::fs::write(&cut, torn).unwrap();
    let _torn = line_of(&cut);
    std::fs::write(&cut, "no such file").unwrap();
    assert!(format!("{:#}", line_of(&cut).unwrap_err()).contains("no MCAP file"));
}

/// Compares MCAP, as the public Python package reads it, with our CSV.
const READER: &str = r"
import csv, math, sys
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

rows, compared = {}, 0
with open(sys.argv[1], 'rb') as file:
    for _, channel, _, message in make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages(log_time_order=False):
        path = sys.argv[2] + channel.topic.replace('/detector/', '/detector-') + '.csv'
        if channel.topic == '/line':
            continue
        row = next(rows.setdefault(path, csv.DictReader(open(path))))
        for name, text in list(row.items())[3:]:
            stem, _, place = name.rpartition('_')
            value = getattr(message, name) if hasattr(message, name) else getattr(message, stem)[int(place) - 1]
            same = text == value if isinstance(value, str) else float(text) == value or math.isnan(value) and text == 'NaN'
            assert same, (channel.topic, name, text, value)
            compared += 1
assert all(next(left, None) is None for left in rows.values()), 'CSV has more rows'
assert compared > 250_000, compared
";

#[test]
#[cfg_attr(not(mcap_reader), ignore = "no mcap-protobuf-support here: `.ci/python` installs it")]
fn the_public_reader_finds_the_numbers_of_the_csv() {
    let Some(python) = option_env!("MCAP_PYTHON") else { panic!("no reader when this was compiled") };
    let folder = tempfile::tempdir().unwrap();
    let (path, csv) = (folder.path().join("scene.mcap"), folder.path().join("csv"));
    record(&path, &line("pick-up-reflex", true));
    assert!(tenax(&["play", path.to_str().unwrap(), "--csv", csv.to_str().unwrap()]).0);
    let read = Command::new(python).args(["-c", READER]).arg(&path).arg(&csv).output().unwrap();
    assert!(read.status.success(), "{}", String::from_utf8_lossy(&read.stderr));
}

#[test]
fn a_recording_overwrites_nothing_says_what_it_lacks_and_names_its_board() {
    let served = trusting();
    let folder = tempfile::tempdir().unwrap();
    let record = |more: &[&str]| {
        let args = [&["record", "--seconds", "0.5", "--port", &served.place], more].concat();
        let output = command(&args).current_dir(folder.path()).stdin(Stdio::null()).output().unwrap();
        (output.status.success(), String::from_utf8(output.stderr).unwrap())
    };
    let (done, said) = record(&[]);
    assert!(done && said.contains("but not replayed"), "{said}");
    let files: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|file| file.unwrap().file_name()).collect();
    let [name] = &files[..] else { panic!("{files:?}") };
    let name = name.to_str().unwrap();
    assert!(name.starts_with("tenax-20") && name.ends_with("Z.mcap"), "{name}");
    let bytes = std::fs::read(folder.path().join(name)).unwrap();
    for known in ["build", "schema", "chip", "began", "s1-mv = 100"] {
        assert!(bytes.windows(known.len()).any(|part| part == known.as_bytes()), "{known}");
    }
    let (done, said) = record(&["--out", name]);
    assert!(!done && said.contains("is there already"), "{said}");
    assert!(std::fs::read(folder.path().join(name)).unwrap() == bytes);
    let (done, said) = record(&["--out", "foo.csv"]);
    assert!(!done && said.contains("call it foo.mcap"), "{said}");
    served.end();
}

#[test]
fn a_recording_from_the_boards_start_decides_the_same_with_the_settings_that_were_kept() {
    let served = Serving::start(BENCH);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("start.mcap");
    // Switched on with nothing held, the board consents for a minute.
    let set = tenax(&["config", "--port", &served.place, "set", "s1-mv=90"]);
    assert!(set.0, "{}", set.2);
    let out = path.to_str().unwrap();
    let mut record =
        command(&["record", "--from-start", "--seconds", "5", "--port", &served.place, "--out", out])
            .stdin(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
    let mut said = BufReader::new(record.stderr.take().unwrap()).lines().map(Result::unwrap);
    assert!(said.any(|line| line.starts_with("Press the board's black reset button")));
    served.tell("reset");
    assert!(said.any(|line| line == "the board has started: recording"));
    for key in ["g", "p"] {
        thread::sleep(Duration::from_secs(1));
        served.tell(key);
    }
    assert!(record.wait().unwrap().success());
    assert_eq!(tenax(&["config", "--port", &served.place, "get", "s1-mv"]).1, "90\n", "flash is kept");
    served.end();
    let outcome = Recorded::of(&line_of(&path).unwrap()).unwrap().replay();
    assert_eq!(outcome.difference, None);
    assert!(outcome.frames > 9_000 && outcome.events > 2, "{outcome:?}");
}
