//! The page's self-test and its bench, over the real HTTP of `tenax monitor --web`: what the page is told, and what it asks for.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::selftest::FAULTS;
use crate::serving::Serving;
use crate::tool::tenax;

const WITHIN: Duration = Duration::from_secs(60);

/// `tenax monitor --web` of a served board.
pub struct Web {
    monitor: Child,
    pub url: String,
}

impl Web {
    /// With these arguments beside the port.
    pub fn watching(place: &str, more: &[&str]) -> Self {
        Self::started(&[&["--port", place], more].concat())
    }

    fn started(args: &[&str]) -> Self {
        let mut monitor = Command::new(env!("CARGO_BIN_EXE_tenax-host"))
            .args(["monitor", "--web", "0"])
            .args(args)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut said = String::new();
        BufReader::new(monitor.stderr.take().unwrap()).read_line(&mut said).unwrap();
        let url =
            said.split(' ').find(|word| word.starts_with("http://")).unwrap_or_else(|| panic!("{said}"));
        Self { monitor, url: url.to_owned() }
    }

    /// Of a recording.
    pub fn playing(file: &Path) -> Self {
        Self::started(&["--file", file.to_str().unwrap()])
    }

    /// What its server has computed so far, s: on Linux, where ticks are of 10 ms.
    pub fn cpu_s(&self) -> f64 {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.monitor.id())).unwrap_or_default();
        let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
        fields.skip(11).take(2).filter_map(|ticks| ticks.parse::<f64>().ok()).sum::<f64>() / 100.0
    }

    fn ask(&self, method: &str, path: &str) -> TcpStream {
        let place = self.url.trim_start_matches("http://").trim_end_matches('/');
        let mut stream = TcpStream::connect(place).unwrap();
        write!(stream, "{method} {path} HTTP/1.1\r\nHost: {place}\r\nOrigin: http://{place}\r\n\r\n")
            .unwrap();
        stream
    }

    /// What the server answers: status and text.
    fn post(&self, path: &str) -> (u16, String) {
        let mut answer = String::new();
        self.ask("POST", path).read_to_string(&mut answer).unwrap();
        let status = answer.split(' ').nth(1).unwrap().parse().unwrap();
        (status, answer.split_once("\r\n\r\n").unwrap().1.to_owned())
    }

    /// What the page is told, event by event.
    fn events(&self) -> impl Iterator<Item = Value> + use<> {
        let lines = BufReader::new(self.ask("GET", "/events")).lines().map(Result::unwrap);
        lines.filter_map(|line| Some(serde_json::from_str(line.strip_prefix("data: ")?).unwrap()))
    }

    /// The first event of which this is so.
    fn until(&self, what: &str, is_so: impl Fn(&Value) -> bool) -> Value {
        let began = Instant::now();
        for event in self.events() {
            if is_so(&event) {
                return event;
            }
            assert!(
                began.elapsed() < WITHIN,
                "never {what}: {} {} {}",
                event["truth"],
                event["line"],
                event["mode"]
            );
        }
        panic!("the page was closed");
    }
}

impl Drop for Web {
    fn drop(&mut self) {
        let _gone = self.monitor.kill();
        let _gone = self.monitor.wait();
    }
}

fn bench(faults: &str) -> (Serving, Web) {
    let served =
        Serving::start_telling(&format!("{}{faults}", include_str!("../../../scenes/parts/bench.toml")));
    let web = Web::watching(&served.places[0], &["--control", "--truth", &served.places[1]]);
    (served, web)
}

/// Starts a test as soon as the board has said its settings.
fn start(web: &Web, path: &str) {
    let began = Instant::now();
    while web.post(path).0 != 202 {
        assert!(began.elapsed() < WITHIN, "{:?}", web.post(path));
    }
}

#[test]
fn the_page_names_exchanged_and_dead_wires_as_the_terminal_does() {
    let (mut served, web) = bench(FAULTS);
    web.until("a bench", |event| event["bench"].is_array());
    assert_eq!(web.post("/selftest/skip").0, 409);
    start(&web, "/selftest/start/fsr/array_2/array_3");
    assert_eq!(
        web.post("/selftest/start/nonsense").1,
        "no channel begins with `nonsense`: docs/wiring.md has them"
    );

    // Whoever reads each prompt touches what it says, at the bench; but not fsr_c.
    let (mut said, mut loudest, mut results, mut last) = (Vec::new(), 0.0_f64, Value::Null, Value::Null);
    for event in web.events() {
        let test = &event["selftest"];
        for line in test["lines"].as_array().unwrap().iter().map(|line| line.as_str().unwrap().to_owned()) {
            let words: Vec<&str> = line.split(' ').collect();
            match words[..] {
                ["press", "fsr_c", ..] => assert_eq!(web.post("/selftest/skip").0, 202),
                [verb @ "press", channel, ..] => {
                    assert_eq!(test["prompt"], line, "what is asked is shown");
                    let channel = channel.trim_end_matches(',');
                    assert_eq!(web.post(&format!("/bench/{verb}/{channel}")).0, 202);
                }
                _ => {}
            }
            said.push(line);
        }
        if let Some(level) = test["level"].as_object() {
            loudest = loudest.max(level["moved_mv"].as_f64().unwrap() / level["needed_mv"].as_f64().unwrap());
        }
        if !test["results"].is_null() {
            results = test["results"].clone();
        }
        last = event;
        if last["selftest"]["over"] == true {
            break;
        }
    }
    served.kill();
    let text = said.join("\n");
    println!("{text}");
    assert!(text.contains("array_2 (switch B, 1) and array_3 (switch B, 2): exchange their wires"));
    assert!(text.contains("fsr_b (switch A, 13): 0 mV: a cut wire"));
    assert!(text.contains("fsr_c (switch A, 14): left out, not tested"));
    assert!(!text.contains("All of switch"), "both wires of it do work");
    assert!(text.ends_with("2 of 6 channels pass"));
    assert!(loudest > 1.5, "the live level shows the touch: {loudest}");
    assert_eq!(last["selftest"]["passes"], false);
    let state = |name: &str| {
        let row = results.as_array().unwrap().iter().find(|row| row[0] == name).unwrap();
        (
            row[1].as_str().unwrap().to_owned(),
            row[2].as_bool(),
            row[3].as_str().unwrap_or_default().to_owned(),
        )
    };
    assert_eq!((state("fsr_a").1, state("fsr_c").1, state("fsr_d").1), (Some(true), None, Some(true)));
    let (input, passes, words) = state("array_2");
    assert_eq!((input.as_str(), passes), ("switch B, 1", Some(false)));
    assert!(words.starts_with("array_3 (switch B, 2) moves in its place"), "{words}");

    // Whoever comes later is told everything once more; a board that is gone ends the next test.
    let late = web.until("an event", |_| true);
    assert_eq!(late["selftest"]["lines"].as_array().unwrap().len(), said.len());
    web.until("gone", |event| event["gone"].is_string());
    assert_eq!(web.post("/selftest/start").0, 409);
    assert_eq!(web.post("/selftest/stop").0, 202);
    web.until("closed", |event| event["selftest"].is_null());
}

#[test]
fn a_test_ends_where_its_board_does() {
    let (mut served, web) = bench("");
    start(&web, "/selftest/start/fsr_a");
    served.kill();
    let event = web.until("an end", |event| event["selftest"]["failed"].is_string());
    assert!(event["selftest"]["failed"].as_str().unwrap().starts_with("the line is gone"), "{event:#}");
}

#[test]
fn the_page_grips_pulls_and_wets_what_its_bench_holds_and_consents() {
    let (mut served, web) = bench("");
    let event = web.until("a bench", |event| event["bench"].is_array());
    let acts: Vec<&str> =
        event["bench"].as_array().unwrap().iter().map(|key| key[0].as_str().unwrap()).collect();
    assert_eq!(acts, ["button", "g", "d", "p", "w", "c", "o", "weight 5"]);

    // As it is switched on it has consent for a minute; a press gives the whole minute anew.
    let left_s = |event: &Value| -> u32 {
        let digits = event["line"].as_str().unwrap_or_default().replace(|c: char| !c.is_ascii_digit(), "");
        digits.parse().unwrap_or(0)
    };
    web.until("less consent", |event| (1..57).contains(&left_s(event)));
    assert_eq!(web.post("/bench/button").0, 202);
    web.until("consent", |event| left_s(event) > 58);
    assert_eq!(web.post("/bench/g").0, 202);
    let holds = |event: &Value| event["truth"]["now"]["grip_n"].as_f64().is_some_and(|n| n > 1.0);
    web.until("a grip", holds);
    web.until("a lift", |event| event["truth"]["now"]["needed_n"].as_f64().unwrap() > 0.1);
    let dry_n = web.until("dry", holds)["truth"]["now"]["needed_n"].as_f64().unwrap();
    assert_eq!(web.post("/bench/w").0, 202);
    web.until("wet", |event| event["truth"]["now"]["needed_n"].as_f64().unwrap() > 1.2 * dry_n);
    assert_eq!(web.post("/bench/p").0, 202);
    web.until("the log", |event| {
        event["log"].as_array().unwrap().iter().any(|line| line == "at the bench: p")
    });
    assert_eq!(web.post("/bench/d").0, 202);
    web.until("put down", |event| event["truth"]["now"]["grip_n"].as_f64().unwrap() <= 0.0);
    served.kill();
    web.until("no bench without its scene", |event| event["bench"].is_null());
    assert_eq!(web.post("/bench/g").0, 404);
}

#[test]
fn a_line_alone_has_no_bench_as_on_a_real_board() {
    let mut served = Serving::start(include_str!("../../../scenes/parts/bench.toml"), &[]);
    let web = Web::watching(&served.places[0], &["--control"]);
    let event = web.until("the board", |event| event["t_s"].as_f64().unwrap() > 1.0);
    assert!(event["bench"].is_null() && event["truth"].is_null());
    let (status, why) = web.post("/bench/g");
    assert!(status == 404 && why.starts_with("no bench"), "{status} {why}");
    served.kill();
}

#[test]
fn a_recording_is_scrubbed_paused_and_its_settings_are_saved_in_the_page() {
    let folder = tempfile::tempdir().unwrap();
    let (line, path) = (folder.path().join("glass.line.bin"), folder.path().join("glass.mcap"));
    let (out, recorded) = (folder.path().to_str().unwrap(), path.to_str().unwrap());
    assert!(tenax(&["run", "--host", "--scene", "glass", "--out", out, "--record", recorded]).0);
    for file in [&line, &path] {
        let web = Web::playing(file);
        let at = |event: &Value| event["playing"]["at_s"].as_f64();
        web.until("the beginning", |event| at(event) > Some(0.3));
        for (control, from_s) in [("40", 40.0), ("-30", 10.0), ("x4", 10.0), ("55.5", 55.5)] {
            let asked = Instant::now();
            assert_eq!(web.post(&format!("/play/{control}")).0, 202);
            let near = |event: &Value| at(event).is_some_and(|at_s| (from_s..from_s + 5.0).contains(&at_s));
            web.until(control, near);
            println!("{}: {control} in {:?}", file.display(), asked.elapsed());
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

#[test]
fn without_control_the_page_tests_wires_and_does_nothing_else() {
    let mut served = Serving::start_telling(include_str!("../../../scenes/parts/bench.toml"));
    let web = Web::watching(&served.places[0], &["--truth", &served.places[1]]);
    web.until("a bench", |event| event["bench"].is_array());
    assert_eq!((web.post("/bench/g").0, web.post("/zero").0), (403, 403));
    start(&web, "/selftest/start/fsr_a");
    served.kill();
}
