//! A recording is played from any second, by the command and on the page.

use std::io::{BufRead, BufReader, Read};
use std::process::Stdio;
use std::time::{Duration, Instant};

use serde_json::Value;
use tenax_frames::link::{Client, Target};
use tenax_hal_shim::wire::Up;

use crate::page::Web;
use crate::recording::{line, record};
use crate::serving::command;

#[test]
fn a_recording_is_played_from_a_second_and_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("glass.mcap");
    record(&path, &line("glass", false));
    let args =
        ["play", "--serve-tcp", "0", "--from", "50", "--loop", "--speed", "20", path.to_str().unwrap()];
    let mut play = command(&args).stderr(Stdio::piped()).spawn().unwrap();
    let mut said = String::new();
    BufReader::new(play.stderr.take().unwrap()).read_line(&mut said).unwrap();
    let target: Target = said.trim().strip_prefix("serving on ").unwrap().parse().unwrap();
    let mut client = Client::open(&target).unwrap();
    // Seconds of the recording.
    let mut hear = || loop {
        if let Some(heard) = client.next_message().unwrap()
            && let Up::Slow(slow) = heard.received.message
        {
            return (slow.frame + 1) / 2_000;
        }
    };
    assert_eq!(hear(), 50);
    while hear() >= 50 {}
    play.kill().unwrap();
    play.wait().unwrap();
}

#[test]
fn a_recording_is_scrubbed_and_paused_and_its_settings_are_saved_in_the_page() {
    let folder = tempfile::tempdir().unwrap();
    let [captured, recorded] = ["glass.line.bin", "glass.mcap"].map(|name| folder.path().join(name));
    let line = line("glass", false);
    std::fs::write(&captured, &line).unwrap();
    record(&recorded, &line);
    for file in [captured, recorded] {
        let web = Web::start(&["--file", file.to_str().unwrap()]);
        let at = |event: &Value| event["playing"]["at_s"].as_f64();
        web.until("the beginning", |event| at(event) > Some(0.3));
        for (control, from_s) in [("40", 40.0), ("-30", 10.0), ("x4", 10.0), ("55.5", 55.5)] {
            let asked = Instant::now();
            assert_eq!(web.post(&format!("/play/{control}")).0, 202);
            web.until(control, |event| at(event).is_some_and(|at_s| (from_s..from_s + 5.0).contains(&at_s)));
            assert!(asked.elapsed() < Duration::from_secs(1), "{control} took {:?}", asked.elapsed());
        }
        web.until("the end", |event| at(event) > Some(59.5) && event["t_s"].as_f64() > Some(59.5));
        assert_eq!(web.post("/play/loop").0, 202);
        web.post("/play/pause");
        let event = web.until("a pause", |event| event["playing"]["paused"] == true);
        assert_eq!((&event["playing"]["repeat"], &event["playing"]["speed"]), (&true.into(), &4.0.into()));
        let mut saved = String::new();
        web.ask("GET", "/settings.toml").read_to_string(&mut saved).unwrap();
        assert!(
            saved.contains("# Board: the host's own build") && saved.contains("\ns1-mv = 100\n"),
            "{saved}"
        );
        assert_eq!(web.post("/set/s1-mv/120").0, 403);
    }
}
