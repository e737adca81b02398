//! Files of a run that somebody stops, or that does not fit on the disk: whole, and told.
#![cfg(unix)]

use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use tenax_frames::link::captured::line_of;

const SIM: &str = env!("CARGO_BIN_EXE_tenax-sim");

#[test]
fn a_run_that_is_stopped_or_finds_the_disk_full_leaves_a_whole_recording() {
    let folder = tempfile::tempdir().unwrap();
    let (stopped, full) = (folder.path().join("stopped.mcap"), folder.path().join("full.mcap"));
    let run = Command::new(SIM)
        .args(["run", "--host", "--serve-tcp", "0", "--out", "out", "--record", "stopped.mcap"])
        .current_dir(&folder)
        .stdin(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let began = Instant::now();
    while std::fs::metadata(&stopped).map_or(0, |file| file.len()) < 10_000 {
        assert!(began.elapsed() < Duration::from_secs(60), "nothing is recorded");
        thread::sleep(Duration::from_millis(20));
    }
    assert!(Command::new("kill").args(["-TERM", &run.id().to_string()]).status().unwrap().success());
    let done = run.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.code() == Some(2) && said.contains("stopped before its end"), "{said}");
    assert!(std::fs::read(&stopped).unwrap().ends_with(b"\x89MCAP0\r\n"));
    assert!(line_of(&stopped).unwrap().len() > 10_000);

    // A file may have 200 blocks of 512 bytes.
    let shell = "trap '' XFSZ; ulimit -f 200; exec \"$0\" run --host --out out --record full.mcap";
    let done = Command::new("sh").args(["-c", shell, SIM]).current_dir(&folder).output().unwrap();
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.code() == Some(2) && said.contains("cannot write "), "{said}");
    assert!(line_of(&full).unwrap().len() > 10_000);
}
