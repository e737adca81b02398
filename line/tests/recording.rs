//! Recordings: what is in them is what was on the line, and decides the same once more.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use tenax_sim::again::Recorded;
use tenax_sim::board::Recorder;
use tenax_sim::live::Use;
use tenax_sim::session::{Board, load_scene};
use tenax_hal_shim::wire::{Answer, Down, FRAME_MAX, Last, PIECE_MAX, Raw, Receiver, Up, encode};
use tenax_hal_shim::words::Fault;
use tenax_scene::World;
use tenax_frames::link::captured::line_of;
use tenax_frames::link::{Client, Target};
use tenax_frames::record::Recording;

use crate::serving::Serving;
use crate::tool::tenax;

const SCENE: &str = "pick-up-reflex";

/// A scene's recording, and the bytes of its line.
fn record(path: &Path, streams_at_start: bool) -> Vec<u8> {
    struct Both(Recording, Vec<u8>);
    impl Recorder for Both {
        fn line(&mut self, bytes: &[u8]) {
            self.0.line(bytes);
            self.1.extend_from_slice(bytes);
        }
    }
    let plant = Use { live: None, streams_at_start }.of(World::new(&load_scene(SCENE).unwrap(), 1));
    let mut both = Both(Recording::create(path).unwrap(), Vec::new());
    Board::Host.record(plant, &mut both, &mut |_| {}).unwrap();
    both.0.finish().unwrap();
    both.1
}

/// A line with every message of frames changed by `change`; None leaves it out.
fn changed(line: &[u8], change: impl Fn(Raw) -> Option<Raw>) -> Vec<u8> {
    let (mut inbox, mut encoder, mut out) =
        (tenax_frames::link::Inbox::default(), tenax_frames::link::Encoder::default(), Vec::new());
    for heard in line.iter().filter_map(|&byte| inbox.push(byte)).flatten() {
        let message = match heard.received.message {
            Up::Raw(raw) => change(raw).map(Up::Raw),
            other => Some(other),
        };
        out.extend(message.iter().flat_map(|message| encoder.frame(message).1.to_vec()));
    }
    out
}

#[test]
fn a_recording_decides_the_same_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.mcap");
    let line = record(&path, true);
    // The zero that ends whatever a reset cut short is no message.
    assert!(line_of(&path).unwrap() == line[1..], "the bytes are those of the line");
    let outcome = Recorded::of(&line).unwrap().replay();
    assert_eq!(outcome.difference, None);
    assert!(outcome.frames >= 11_990 && outcome.slows >= 479 && outcome.events > 5, "{outcome:?}");
    let (_, said, _) = tenax(&["run", "--replay", path.to_str().unwrap()]);
    assert_eq!(said.trim(), outcome.to_string());
    // The control: one bit of one sample is another decision, or at least another checksum.
    let torn = changed(&line, |mut raw| {
        if raw.first == 4_000 {
            let mut frame = raw.frames()[2];
            frame.pvdf[5] ^= 1;
            raw.put(&frame);
        }
        Some(raw)
    });
    assert!(Recorded::of(&torn).unwrap().replay().difference.is_some());
}

#[test]
fn what_is_missing_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let line = record(&folder.path().join("scene.mcap"), true);
    let error = |line: &[u8]| format!("{:#}", Recorded::of(line).unwrap_err());
    let gap = changed(&line, |raw| (raw.first != 4_000).then_some(raw));
    assert!(error(&gap).contains("frame 4000 is missing, and after it comes 4005"), "{}", error(&gap));
    let joined_late = &line[line.len() / 2..];
    assert!(error(joined_late).contains("does not begin before the board's start"));
    let plain = record(&folder.path().join("plain.mcap"), false);
    assert!(error(&plain).contains("has no frames: set stream-at-start-flag to 1"), "{}", error(&plain));
}

/// MCAP as the public Python package reads it, against our CSV.
const READER: &str = r"
import csv, math, sys
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

topics = {}
with open(sys.argv[1], 'rb') as file:
    for _, channel, _, message in make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages():
        topics.setdefault(channel.topic, []).append(message)
compared = 0
for topic, messages in topics.items():
    if topic == '/line':
        continue
    rows = list(csv.DictReader(open(sys.argv[2] + '/' + topic[1:].replace('/', '-') + '.csv')))
    assert len(rows) == len(messages), topic
    for row, message in zip(rows, messages):
        for name, text in row.items():
            if name == 'time_s':
                continue
            stem, _, place = name.rpartition('_')
            value = getattr(message, stem)[int(place) - 1] if not hasattr(message, name) else getattr(message, name)
            if isinstance(value, bool):
                assert text == str(int(value)), (topic, name)
            elif isinstance(value, float):
                assert float(text) == value or math.isnan(value) and text == 'NaN', (topic, name, text, value)
            else:
                assert text == value, (topic, name)
            compared += 1
print(compared)
";

#[test]
#[ignore = "needs Python's mcap and mcap-protobuf-support: TENAX_PYTHON=python cargo test ... -- --ignored"]
fn the_public_reader_finds_the_numbers_of_the_csv() {
    let python = std::env::var("TENAX_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.mcap");
    record(&path, true);
    let csv = folder.path().join("csv");
    assert!(tenax(&["play", path.to_str().unwrap(), "--csv", csv.to_str().unwrap()]).0);
    let read = Command::new(&python).args(["-c", READER]).arg(&path).arg(&csv).output().unwrap();
    assert!(read.status.success(), "{}", String::from_utf8_lossy(&read.stderr));
    let compared: u32 = String::from_utf8(read.stdout).unwrap().trim().parse().unwrap();
    println!("{compared} values compared");
    assert!(compared > 250_000, "{compared}");
}

#[test]
fn a_recording_overwrites_nothing_says_what_it_lacks_and_names_its_board() {
    let served = Serving::trusting();
    let folder = tempfile::tempdir().unwrap();
    let record = |more: &[&str]| {
        let Output { status, stderr, .. } = Command::new(env!("CARGO_BIN_EXE_tenax-host"))
            .current_dir(folder.path())
            .args(["record", "--seconds", "0.5", "--port", &served.places[0]])
            .args(more)
            .output()
            .unwrap();
        (status.success(), String::from_utf8(stderr).unwrap())
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
    drop(served.end());
}

#[test]
fn who_restarts_the_stream_gets_a_recording_that_decides_the_same_with_the_settings_that_were_kept() {
    let mut served = Serving::looping(include_str!("../../../scenes/parts/bench.toml"));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("start.mcap");
    // Who switched the board on may set it for a while.
    let set = tenax(&["config", "--port", &served.places[0], "set", "s1-mv=90"]);
    assert!(set.0, "{}", set.2);
    let mut record = Command::new(env!("CARGO_BIN_EXE_tenax-host"))
        .args(["record", "--from-start", "--seconds", "5", "--port", &served.places[0], "--out"])
        .arg(&path)
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
    assert_eq!(tenax(&["config", "--port", &served.places[0], "get", "s1-mv"]).1, "90\n", "flash is kept");
    served.kill();
    let outcome = Recorded::of(&line_of(&path).unwrap()).unwrap().replay();
    assert_eq!(outcome.difference, None);
    assert!(outcome.frames > 9_000 && outcome.events > 2, "{outcome:?}");
}

#[test]
fn an_hour_is_less_than_60_mb_and_is_played_from_any_second() {
    // Somebody is busy at the bench all the time.
    let mut served = Serving::start(include_str!("../../../scenes/parts/bench.toml"), &[]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("compact.mcap");
    let mut record = Command::new(env!("CARGO_BIN_EXE_tenax-host"))
        .args(["record", "--compact", "--seconds", "24", "--port", &served.places[0], "--out"])
        .arg(&path)
        .spawn()
        .unwrap();
    for key in ["g", "w", "p", "d"].repeat(2) {
        served.tell(key);
        thread::sleep(Duration::from_secs(3));
    }
    assert!(record.wait().unwrap().success());
    served.kill();
    let bytes = std::fs::metadata(&path).unwrap().len();
    println!("{bytes} bytes of 24 s");
    assert!(bytes * 3_600 / 24 < 60_000_000, "{bytes} bytes of 24 s");

    // All that is left out is made of the line.
    let csv = folder.path().join("csv");
    assert!(tenax(&["play", path.to_str().unwrap(), "--csv", csv.to_str().unwrap()]).0);
    let ticks = std::fs::read_to_string(csv.join("tick.csv")).unwrap().lines().count();
    assert!(ticks > 24 * 1_900, "{ticks}");

    // From its twentieth second, and again from its beginning; then where a person says.
    let play = Command::new(env!("CARGO_BIN_EXE_tenax-host"))
        .args(["play", "--serve-tcp", "0", "--from", "20", "--loop", "--speed", "20"])
        .arg(&path)
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut play = Ends(play);
    let mut said = String::new();
    BufReader::new(play.0.stderr.take().unwrap()).read_line(&mut said).unwrap();
    let target: Target = said.trim().strip_prefix("serving on ").unwrap().parse().unwrap();
    let mut client = Client::open(&target).unwrap();
    let (mut frames, began) = (Vec::new(), Instant::now());
    let mut hear = |frames: &mut Vec<u32>| {
        assert!(began.elapsed() < Duration::from_secs(30), "it is not played again");
        if let Some(heard) = client.next_message().unwrap()
            && let Up::Slow(slow) = heard.received.message
        {
            frames.push(slow.frame);
        }
    };
    while frames.windows(2).all(|pair| pair[0] < pair[1]) {
        hear(&mut frames);
    }
    let (again, first) = (frames.pop().unwrap(), frames[0]);
    let last = frames.last().unwrap();
    assert!((4_000..10_000).contains(&(last - first)), "4 of 24 s: {first} to {last}");
    assert!(first - again > 39_000, "20 s before: {again}");
    let mut keys = play.0.stdin.take().unwrap();
    for second in [12, 22, 3, 17] {
        writeln!(keys, "{second}").unwrap();
        let asked = Instant::now();
        // At twenty times its pace it has gone on by a second of itself at most when it is heard.
        let wanted = again + second * 2_000;
        loop {
            hear(&mut frames);
            let frame = *frames.last().unwrap();
            if (wanted..wanted + 2_000).contains(&frame) {
                break;
            }
            assert!(
                asked.elapsed() < Duration::from_secs(1),
                "second {second}: {frame} in place of {wanted}"
            );
        }
        println!("second {second} in {:?}", asked.elapsed());
    }
}

/// Ends a command that would go on.
struct Ends(Child);

impl Drop for Ends {
    fn drop(&mut self) {
        let _gone = self.0.kill();
        let _gone = self.0.wait();
    }
}

/// A stand-in for a board that has kept these bytes: where it is. It serves two clients, one after the other.
fn keeper(mut kept: Vec<u8>) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let place = format!("tcp:{}", listener.local_addr().unwrap());
    thread::spawn(move || {
        for mut stream in listener.incoming().flatten().take(2) {
            let (mut receiver, mut bytes) = (Receiver::new(), [0; 256]);
            while let Ok(count @ 1..) = stream.read(&mut bytes) {
                for command in bytes[..count].iter().filter_map(|&byte| receiver.push::<Down>(byte)).flatten()
                {
                    let Down::Last(from) = command.message else { continue };
                    let mut last = Last::nothing(from);
                    if let Some(rest) = kept.get(usize::from(from)..).filter(|rest| !rest.is_empty()) {
                        last.after = Some(Fault::PanicReset);
                        last.why = b"scan.rs:7".iter().copied().collect();
                        last.length = kept.len() as u16;
                        last.bytes = rest.iter().copied().take(PIECE_MAX).collect();
                    } else {
                        kept.clear();
                    }
                    let up = Up::Answer { of: command.sequence, frame: 0, answer: Answer::Last(last) };
                    stream.write_all(encode(0, &up, &mut [0; FRAME_MAX]).unwrap()).unwrap();
                }
            }
        }
    });
    place
}

#[test]
fn the_seconds_before_a_fault_are_a_recording() {
    let folder = tempfile::tempdir().unwrap();
    let line = record(&folder.path().join("scene.mcap"), false);
    // From the middle of a message on, as a box is that was written round.
    let kept = line[line.len() - 40_003..].to_vec();
    let (place, path) = (keeper(kept.clone()), folder.path().join("fault.mcap"));
    let (file, csv) = (path.to_str().unwrap(), folder.path().join("csv"));
    let args = ["record", "--last", "--port", &place, "--out", file];
    let (done, _, said) = tenax(&args);
    assert!(done && said.contains(" (scan.rs:7): ") && said.contains(" bytes, 2."), "{said}");
    let first = kept.iter().position(|&byte| byte == 0).unwrap() + 1;
    assert!(line_of(&path).unwrap() == kept[first..], "every whole message");
    let (again, _, said) = tenax(&args);
    assert!(!again && said.contains("the board keeps nothing"), "{said}");

    assert!(tenax(&["play", file, "--csv", csv.to_str().unwrap()]).0);
    assert!(std::fs::read_to_string(csv.join("state.csv")).unwrap().lines().count() > 160);
    let (drawn, _, said) = tenax(&["plot", file]);
    assert!(drawn && path.with_extension("png").exists(), "{said}");
}
