//! A recording is whole at every moment, whatever ends it, and says at once what it cannot do.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};
use std::thread;
use std::time::{Duration, Instant};

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_frames::link::captured::line_of;
use tenax_frames::link::{Client, Inbox};
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::wire::Up;

use crate::serving::{BENCH, Serving, busy, command, relay, tenax, trusting};

fn record(place: &str, path: &Path, more: &[&str]) -> Child {
    let args = [&["record", "--port", place, "--out", path.to_str().unwrap()], more].concat();
    let child = command(&args).stdin(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let began = Instant::now();
    while std::fs::metadata(path).map_or(0, |file| file.len()) == 0 {
        assert!(began.elapsed() < Duration::from_secs(20), "nothing is recorded");
        thread::sleep(Duration::from_millis(10));
    }
    child
}

/// A line to the place whose first connection ends after this time, and that is back 1.3 s later.
fn cut_after(place: &str, lives: Duration) -> String {
    let mut lives = Some(lives);
    relay(place, move |mut up, mut far| match lives.take() {
        Some(lives) => {
            let near = up.try_clone().unwrap();
            thread::spawn(move || std::io::copy(&mut up, &mut far));
            thread::sleep(lives);
            near.shutdown(std::net::Shutdown::Both).unwrap();
            thread::sleep(Duration::from_millis(1_300));
        }
        None => _ = std::io::copy(&mut up, &mut far),
    })
}

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([name, &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

fn last_frame(path: &Path) -> u32 {
    let (line, mut inbox) = (line_of(path).unwrap(), Inbox::default());
    let frames = line.iter().filter_map(|&byte| inbox.push(byte)).flatten();
    let slow = frames.filter_map(|heard| match heard.received.message {
        Up::Slow(slow) => Some(slow.frame),
        _ => None,
    });
    slow.last().unwrap()
}

/// Twelve recorders are killed at drawn instants; another client of the line knows what the board had said by then.
#[test]
fn one_that_is_killed_loses_at_most_its_last_second() {
    let _busy = busy();
    let (served, folder) = (trusting(), tempfile::tempdir().unwrap());
    let (newest, mut rng) = (AtomicU32::default(), ChaCha8Rng::seed_from_u64(7));
    let mut witness = Client::open(&served.place.parse().unwrap()).unwrap();
    let files: Vec<_> = (0..12).map(|n| folder.path().join(format!("{n}.mcap"))).collect();
    thread::scope(|scope| {
        let killers: Vec<_> = files
            .iter()
            .map(|path| (path, Duration::from_millis(rng.random_range(700..4_000))))
            .map(|(path, lives)| {
                let (place, newest) = (&served.place, &newest);
                scope.spawn(move || {
                    let mut child = record(place, path, &[]);
                    thread::sleep(lives);
                    let said = newest.load(Relaxed);
                    child.kill().unwrap();
                    child.wait().unwrap();
                    (path, said)
                })
            })
            .collect();
        while killers.iter().any(|killer| !killer.is_finished()) {
            if let Some(Up::Slow(slow)) = witness.next_message().unwrap().map(|heard| heard.received.message)
            {
                newest.store(slow.frame, Relaxed);
            }
        }
        for (path, said) in killers.into_iter().map(|killer| killer.join().unwrap()) {
            let lost_s = f64::from(said.saturating_sub(last_frame(path))) / f64::from(FRAME_HZ);
            assert!(lost_s <= 1.0, "{lost_s} s of {} are lost", path.display());
        }
    });
    #[cfg(mcap_reader)]
    {
        let package = Path::new(env!("CARGO_MANIFEST_DIR")).join("../python");
        let read = "import sys, tenax\nfor path in sys.argv[1:]:\n    with tenax.open(path) as board:\n        \
                    assert len(tenax.states(board)['time_s']) > 10 and board.truncated, path";
        let read = Command::new(env!("MCAP_PYTHON"))
            .env("PYTHONPATH", package)
            .args(["-W", "ignore", "-c", read])
            .args(&files)
            .output()
            .unwrap();
        assert!(read.status.success(), "{}", String::from_utf8_lossy(&read.stderr));
    }
    served.end();
}

#[test]
fn signals_a_full_disk_and_a_lines_end_leave_whole_files_and_are_told() {
    let (served, folder) = (trusting(), tempfile::tempdir().unwrap());
    let at = |name: &str| folder.path().join(name).with_extension("mcap");
    for name in ["-INT", "-TERM", "-HUP"] {
        let child = record(&served.place, &at(name), &[]);
        thread::sleep(Duration::from_millis(300));
        signal(&child, name);
        let done = child.wait_with_output().unwrap();
        assert!(done.status.success(), "{name}: {}", String::from_utf8_lossy(&done.stderr));
        assert!(std::fs::read(at(name)).unwrap().ends_with(mcap_end()), "{name}");
    }
    // A file may have 100 blocks of 512 bytes, and nobody is there to stop the recorder.
    let full = at("full");
    let shell = "trap '' XFSZ; ulimit -f 100; exec \"$0\" record --port \"$1\" --out \"$2\"";
    let began = Instant::now();
    let done = Command::new("sh")
        .args(["-c", shell, env!("CARGO_BIN_EXE_tenax"), &served.place, full.to_str().unwrap()])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(
        done.status.code() == Some(2) && said.contains("full.mcap, which is whole up to there: "),
        "{said}"
    );
    assert!(began.elapsed() < Duration::from_secs(20) && last_frame(&full) > 0);

    // Its line ends for a moment, is back, and ends for good.
    let child =
        record(&cut_after(&served.place, Duration::from_millis(1_000)), &at("end"), &["--seconds", "12"]);
    thread::sleep(Duration::from_millis(6_500));
    served.end();
    let done = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.code() == Some(2) && said.matches("the line ended after ").count() == 3, "{said}");
    assert!(std::fs::read(at("end")).unwrap().ends_with(mcap_end()));
    let csv = folder.path().join("csv");
    assert!(tenax(&["play", at("end").to_str().unwrap(), "--csv", csv.to_str().unwrap()]).0);
    let events = std::fs::read_to_string(csv.join("event.csv")).unwrap();
    assert!(events.contains("nothing came for "), "{events}");
    assert!(f64::from(last_frame(&at("end"))) / f64::from(FRAME_HZ) > 3.0, "it goes on");
}

#[test]
fn time_goes_on_where_the_board_is_reset() {
    let (served, folder) = (Serving::start(BENCH), tempfile::tempdir().unwrap());
    let path = folder.path().join("reset.mcap");
    let mut child = record(&served.place, &path, &["--seconds", "5"]);
    thread::sleep(Duration::from_millis(2_500));
    served.tell("reset");
    assert!(child.wait().unwrap().success());
    served.end();
    let csv = folder.path().join("csv");
    assert!(tenax(&["play", path.to_str().unwrap(), "--csv", csv.to_str().unwrap()]).0);
    let events = std::fs::read_to_string(csv.join("event.csv")).unwrap();
    assert!(events.contains("hello: "), "the restart is an event: {events}");
    for topic in ["state", "tick", "frame", "counters"] {
        let text = std::fs::read_to_string(csv.join(topic).with_extension("csv")).unwrap();
        let times =
            |row: &str| -> Vec<f64> { row.split(',').take(3).map(|cell| cell.parse().unwrap()).collect() };
        let rows: Vec<Vec<f64>> = text.lines().skip(1).map(times).collect();
        let back = |n: usize| rows.windows(2).filter(|pair| pair[1][n] < pair[0][n]).count();
        assert_eq!((back(0), back(1), back(2)), (0, 1, 0), "{topic}: file, board and host");
        // The crystal of a served board is this computer's clock.
        let (first, last) = (&rows[0], &rows[rows.len() - 1]);
        assert!(((last[0] - first[0]) - (last[2] - first[2])).abs() < 0.5, "{topic}: {first:?} {last:?}");
    }
}

/// The MCAP format's magic bytes end a whole file.
const fn mcap_end() -> &'static [u8] {
    b"\x89MCAP0\r\n"
}
