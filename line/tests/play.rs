//! A recording is played on the page from any second.

use std::io::Read;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::page::Web;
use crate::recording::{line, record};

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
