//! A recording is whole at every moment, whatever ends it, and says at once what it cannot do.

use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_frames::link::captured::line_of;
use tenax_frames::link::{Client, Heard, Inbox};
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::wire::Up;

use crate::serving::{BENCH, Serving, asked, busy, command, relay_on, tenax, trusting};

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

/// Records for so long as the file has no more than these blocks of 512 bytes.
fn fills(blocks: u32, place: &str, path: &Path) {
    let shell = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" record --port \"$1\" --out \"$2\"");
    let recorder = ["-c", &shell, env!("CARGO_BIN_EXE_tenax"), place];
    let done = Command::new("sh").args(recorder).arg(path).output().unwrap();
    let said = String::from_utf8(done.stderr).unwrap();
    assert!(done.status.code() == Some(2) && said.contains(".mcap, which is whole up to there: "), "{said}");
}

/// A line to the place whose first connection ends after this time, and that is back so much later; `newest` at both instants.
fn cut_after(
    place: &str,
    lives: Duration,
    gone: Duration,
    newest: &Arc<AtomicU32>,
) -> (String, Receiver<u32>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let (own, place, newest) = (listener.local_addr().unwrap(), place.to_owned(), Arc::clone(newest));
    let (tell, told) = channel();
    thread::spawn(move || {
        relay_on(listener, &place, |mut up, mut far| {
            thread::spawn(move || std::io::copy(&mut up, &mut far));
            thread::sleep(lives);
            let _unheard = tell.send(newest.load(Relaxed));
            false
        });
        thread::sleep(gone);
        let _unheard = tell.send(newest.load(Relaxed));
        relay_on(TcpListener::bind(own).unwrap(), &place, |mut up, mut far| {
            std::io::copy(&mut up, &mut far).is_ok()
        });
    });
    (format!("tcp:{own}"), told)
}

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([name, &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

fn slow_frames(path: &Path) -> Vec<u32> {
    let (line, mut inbox) = (line_of(path).unwrap(), Inbox::default());
    let slow = |heard: Heard| match heard.received.message {
        Up::Slow(slow) => Some(slow.frame),
        _ => None,
    };
    line.iter().filter_map(|&byte| inbox.push(byte)?.ok()).filter_map(slow).collect()
}

fn last_frame(path: &Path) -> u32 {
    slow_frames(path).pop().unwrap()
}

#[derive(Clone, Copy, Debug)]
enum End {
    Kill,
    /// Blocks of 512 bytes.
    FullDisk(u32),
    Cut,
    /// After which time the line is back; then it is killed.
    Back(Duration),
}

/// Ends a recording after its life; frames that it lost. `newest`: the newest slow frame that the board has sent.
fn lost(end: End, lives: Duration, place: &str, path: &Path, newest: &Arc<AtomicU32>) -> u32 {
    let killed = |mut child: Child| {
        let said = newest.load(Relaxed);
        child.kill().unwrap();
        child.wait().unwrap();
        said
    };
    match end {
        End::Kill => {
            let child = record(place, path, &[]);
            thread::sleep(lives);
            killed(child).saturating_sub(last_frame(path))
        }
        End::FullDisk(blocks) => {
            fills(blocks, place, path);
            newest.load(Relaxed).saturating_sub(last_frame(path))
        }
        End::Cut => {
            let (place, told) = cut_after(place, lives, Duration::from_secs(60), newest);
            let child = record(&place, path, &[]);
            let said = told.recv().unwrap();
            thread::sleep(Duration::from_millis(200));
            signal(&child, "-TERM");
            let done = child.wait_with_output().unwrap();
            let told = String::from_utf8_lossy(&done.stderr);
            let ends = told.matches("the line ended after ").count();
            assert!(done.status.code() == Some(2) && ends >= 1, "{told}");
            assert!(std::fs::read(path).unwrap().ends_with(mcap_end()), "it is whole");
            said.saturating_sub(last_frame(path))
        }
        End::Back(gone) => {
            let (place, told) = cut_after(place, lives, gone, newest);
            let child = record(&place, path, &[]);
            let away = (told.recv().unwrap(), told.recv().unwrap());
            thread::sleep(Duration::from_secs(1) + lives);
            let (said, frames) = (killed(child), slow_frames(path));
            let csv = path.with_extension("csv");
            assert!(tenax(&["play", path.to_str().unwrap(), "--csv", csv.to_str().unwrap()]).0);
            let events = std::fs::read_to_string(csv.join("event.csv")).unwrap();
            assert!(gone < Duration::from_millis(1_100) || events.contains("nothing came for "), "{events}");
            let gap = frames.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap();
            assert!(*frames.last().unwrap() > away.1, "{frames:?} around {away:?}");
            (said - frames.last().unwrap()).max(gap.saturating_sub(away.1 - away.0))
        }
    }
}

/// Recorders end at drawn instants, sixteen at once; another client of the line knows what the board had said by then.
/// `TENAX_ENDS=200` is the bar.
#[test]
fn whatever_ends_a_recording_loses_at_most_its_last_second() {
    let _busy = busy();
    let (ends, seed) = (asked("TENAX_ENDS").unwrap_or(16), asked("TENAX_SEED").unwrap_or(7));
    println!("seed {seed}");
    let (folder, mut rng) = (tempfile::tempdir().unwrap(), ChaCha8Rng::seed_from_u64(seed));
    let draws: Vec<_> = (0..ends)
        .map(|n| {
            let end = match n % 4 {
                0 => End::Kill,
                1 => End::FullDisk(rng.random_range(100..1_500)),
                2 => End::Cut,
                _ => End::Back(Duration::from_millis(rng.random_range(50..1_500))),
            };
            let path = folder.path().join(format!("{n}.mcap"));
            (end, Duration::from_millis(rng.random_range(700..4_000)), path)
        })
        .collect();
    for some in draws.chunks(16) {
        let (served, newest) = (trusting(), Arc::<AtomicU32>::default());
        let mut witness = Client::open(&served.place.parse().unwrap()).unwrap();
        thread::scope(|scope| {
            let (place, newest) = (&served.place, &newest);
            let recorders: Vec<_> = some
                .iter()
                .map(|(end, lives, path)| scope.spawn(move || lost(*end, *lives, place, path, newest)))
                .collect();
            while recorders.iter().any(|recorder| !recorder.is_finished()) {
                if let Some(Up::Slow(slow)) =
                    witness.next_message().unwrap().map(|heard| heard.received.message)
                {
                    newest.store(slow.frame, Relaxed);
                }
            }
            for (recorder, (end, lives, _)) in recorders.into_iter().zip(some) {
                let lost_s = f64::from(recorder.join().unwrap()) / f64::from(FRAME_HZ);
                println!("{end:?} after {lives:?}: {lost_s} s are lost");
                assert!(lost_s <= 1.0, "seed {seed}, {end:?} after {lives:?}: {lost_s} s are lost");
            }
        });
        served.end();
    }
    #[cfg(mcap_reader)]
    {
        let package = Path::new(env!("CARGO_MANIFEST_DIR")).join("../python");
        let read = Command::new(env!("MCAP_PYTHON"))
            .env("PYTHONPATH", package)
            .args(["-W", "ignore", "-c", READS])
            .args(draws.iter().map(|(_, _, path)| path))
            .output()
            .unwrap();
        assert!(read.status.success(), "{}", String::from_utf8_lossy(&read.stderr));
    }
}

/// Every file by the public reader, and by ours: one that no signal ended lacks its end, and is said to.
#[cfg(mcap_reader)]
const READS: &str = "
import struct, sys, tenax
from mcap.exceptions import EndOfFile
from mcap.records import Message
from mcap.stream_reader import StreamReader
for n, path in enumerate(sys.argv[1:]):
    messages = 0
    try:
        for record in StreamReader(open(path, 'rb'), validate_crcs=True).records:
            messages += isinstance(record, Message)
    # The reader gives the second where a record's length is cut short.
    except (EndOfFile, struct.error):
        pass
    with tenax.open(path) as board:
        # The smallest disk is full before the first chunk is whole.
        assert n % 4 == 1 or messages > 1000 and len(tenax.states(board)['time_s']) > 10, (path, messages)
        # A full disk may have room for the end.
        assert n % 4 == 1 or board.truncated == (n % 4 != 2), path
";

#[test]
fn signals_leave_whole_files() {
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
    served.end();
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
    std::fs::remove_file(csv.join("tick.csv")).unwrap();
    std::os::unix::fs::symlink("/dev/full", csv.join("tick.csv")).unwrap();
    let (done, _, said) = tenax(&["play", path.to_str().unwrap(), "--csv", csv.to_str().unwrap()]);
    assert!(!done && said.contains(&format!("folder {}: No space", csv.display())), "{said}");
}

/// The MCAP format's magic bytes end a whole file.
const fn mcap_end() -> &'static [u8] {
    b"\x89MCAP0\r\n"
}
