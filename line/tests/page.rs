//! The page of `tenax monitor`, over its HTTP: what it is told, and what it asks for.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Map, Value};

use crate::selftest::fault;
use crate::serving::{BENCH, Serving, command};

const WITHIN: Duration = Duration::from_secs(60);

/// `tenax monitor` and the address of its page.
pub struct Web {
    monitor: Child,
    pub url: String,
}

impl Web {
    pub fn start(args: &[&str]) -> Self {
        let args = [&["monitor", "--web", "0"], args].concat();
        let mut monitor = command(&args).stderr(Stdio::piped()).spawn().unwrap();
        let mut said = String::new();
        BufReader::new(monitor.stderr.take().unwrap()).read_line(&mut said).unwrap();
        let url = said.split(' ').find(|word| word.starts_with("http://"));
        let url = url.unwrap_or_else(|| panic!("{said}")).to_owned();
        Self { monitor, url }
    }

    /// Of a served board and its scene's true state.
    pub fn watching(served: &Serving, more: &[&str]) -> Self {
        Self::start(&[&["--port", &served.place, "--truth", &served.truth], more].concat())
    }

    fn place(&self) -> &str {
        self.url.trim_start_matches("http://").trim_end_matches('/')
    }

    /// Sends a request with these header lines.
    fn request(&self, method: &str, path: &str, headers: &str) -> TcpStream {
        let mut stream = TcpStream::connect(self.place()).unwrap();
        write!(stream, "{method} {path} HTTP/1.1\r\n{headers}Connection: close\r\n\r\n").unwrap();
        stream
    }

    pub fn ask(&self, method: &str, path: &str) -> TcpStream {
        let place = self.place();
        self.request(method, path, &format!("Host: {place}\r\nOrigin: http://{place}\r\n"))
    }

    /// Status and text of the answer.
    pub fn post(&self, path: &str) -> (u16, String) {
        answer(self.ask("POST", path))
    }

    /// The state, then its changes.
    pub fn changes(&self) -> impl Iterator<Item = Map<String, Value>> + use<> {
        let lines = BufReader::new(self.ask("GET", "/events")).lines().map(Result::unwrap);
        let batch = |line: String| serde_json::from_str(line.strip_prefix("data: ")?).unwrap();
        lines.filter_map(batch).flat_map(|batch: Vec<Map<String, Value>>| batch)
    }

    /// The state after each change.
    pub fn events(&self) -> impl Iterator<Item = Value> + use<> {
        let mut state = Map::new();
        self.changes().map(move |change| {
            state.extend(change);
            Value::Object(state.clone())
        })
    }

    /// The first event of which this is so.
    pub fn until(&self, what: &str, is_so: impl Fn(&Value) -> bool) -> Value {
        let began = Instant::now();
        let is_found = |event: &Value| {
            assert!(began.elapsed() < WITHIN, "never {what}: {} {}", event["truth"], event["line"]);
            is_so(event)
        };
        self.events().find(is_found).expect("the page stays open")
    }

    /// Starts a self-test as soon as the board has said its settings.
    fn selftest(&self, channels: &str) {
        let (path, began) = (format!("/selftest/start/{channels}"), Instant::now());
        while self.post(&path).0 != 202 {
            assert!(began.elapsed() < WITHIN, "{:?}", self.post(&path));
        }
    }
}

impl Drop for Web {
    fn drop(&mut self) {
        let _gone = self.monitor.kill();
        let _gone = self.monitor.wait();
    }
}

fn answer(mut stream: TcpStream) -> (u16, String) {
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    let status = answer.split(' ').nth(1).unwrap().parse().unwrap();
    (status, answer.split_once("\r\n\r\n").unwrap().1.to_owned())
}

/// A touch of each channel that is asked for; fsr_c is left out.
#[test]
fn the_page_names_exchanged_and_dead_wires() {
    let faults = fault("array_2", "swapped", "array_3") + &fault("fsr_b", "dead", "");
    let served = Serving::start(&(BENCH.to_owned() + &faults));
    let web = Web::watching(&served, &["--control"]);
    web.until("a bench", |event| event["bench"].is_array());
    assert_eq!(web.post("/selftest/skip").0, 409);
    web.selftest("fsr/array_2/array_3");
    assert!(web.post("/selftest/start/nonsense").1.starts_with("no channel begins with `nonsense`"));

    let (mut said, mut loudest, mut results) = (Vec::new(), 0.0_f64, Value::Null);
    for test in web.changes().filter_map(|mut change| change.remove("selftest")) {
        for line in test["lines"].as_array().unwrap().iter().map(|line| line.as_str().unwrap().to_owned()) {
            match line.split(' ').collect::<Vec<_>>()[..] {
                ["press", "fsr_c", ..] => assert_eq!(web.post("/selftest/skip").0, 202),
                ["press", channel, ..] => {
                    assert_eq!(test["prompt"], line, "what is asked is shown");
                    let channel = channel.trim_end_matches(',');
                    assert_eq!(web.post(&format!("/bench/press/{channel}")).0, 202);
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
        if test["over"] == true {
            assert_eq!(test["passes"], false);
            break;
        }
    }
    let text = said.join("\n");
    assert!(text.contains("array_2 (switch B, 1) and array_3 (switch B, 2): exchange their wires"), "{text}");
    assert!(text.contains("fsr_b (switch A, 13): 0 mV: a cut wire"), "{text}");
    assert!(text.contains("fsr_c (switch A, 14): left out, not tested"), "{text}");
    assert!(!text.contains("All of switch") && text.ends_with("2 of 6 channels pass"), "{text}");
    assert!(loudest > 1.5, "the live level shows the touch: {loudest}");
    let row = |name: &str| results.as_array().unwrap().iter().find(|row| row[0] == name).unwrap().clone();
    let passes = ["fsr_a", "fsr_c", "fsr_d", "array_2"].map(|name| row(name)[2].as_bool());
    assert_eq!(passes, [Some(true), None, Some(true), Some(false)]);
    let words = row("array_2")[3].as_str().unwrap().to_owned();
    assert!(words.starts_with("array_3 (switch B, 2) moves in its place"), "{words}");

    // A page that is opened later is told all lines; a board that is gone ends the next test.
    let late = web.until("an event", |_| true);
    assert_eq!(late["selftest"]["lines"].as_array().unwrap().len(), said.len());
    web.selftest("fsr_a");
    served.end();
    let event = web.until("an end", |event| event["selftest"]["failed"].is_string());
    assert!(event["selftest"]["failed"].as_str().unwrap().starts_with("the line is gone"), "{event:#}");
    assert_eq!((web.post("/selftest/start").0, web.post("/selftest/stop").0), (409, 202));
    web.until("closed", |event| event["selftest"].is_null());
}

#[test]
fn the_page_grips_and_wets_what_its_bench_holds_and_consents() {
    let served = Serving::start(BENCH);
    let web = Web::watching(&served, &["--control"]);
    let event = web.until("a bench", |event| event["bench"].is_array());
    assert_eq!(event["bench"][0][0], "g");
    // As it is switched on it has consent for a minute; a press gives the whole minute anew.
    let left_s = |event: &Value| -> u32 {
        let digits = event["line"].as_str().unwrap_or_default().replace(|c: char| !c.is_ascii_digit(), "");
        digits.parse().unwrap_or(0)
    };
    web.until("less consent", |event| (1..57).contains(&left_s(event)));
    assert_eq!(web.post("/bench/button").0, 202);
    web.until("consent", |event| left_s(event) > 58);
    assert_eq!(web.post("/set/s1-mv/120").0, 202);
    web.until("the setting", |event| event["s1_mv"] == 120);
    assert_eq!(web.post("/bench/g").0, 202);
    let (grip, needed) = (
        |event: &Value| event["truth"]["grip_n"].as_f64().unwrap_or(0.0),
        |event: &Value| event["truth"]["needed_n"].as_f64().unwrap_or(0.0),
    );
    web.until("a grip", |event| grip(event) > 1.0);
    let dry_n = needed(&web.until("a lift", |event| needed(event) > 0.1));
    assert_eq!(web.post("/bench/w").0, 202);
    web.until("wet", |event| needed(event) > 1.2 * dry_n);
    let says = |event: &Value| event["log"].as_array().unwrap().iter().any(|line| line == "at the bench: w");
    web.until("the log", says);
    assert_eq!(web.post("/bench/d").0, 202);
    web.until("put down", |event| grip(event) <= 0.0);
    served.end();
    web.until("no bench without its scene", |event| event["bench"].is_null());
    assert_eq!(web.post("/bench/g").0, 404);
}

#[test]
fn only_pages_of_this_address_may_ask_and_without_control_they_change_nothing() {
    let served = Serving::start(BENCH);
    let web = Web::watching(&served, &[]);
    let own = web.place().to_owned();
    for (host, origin) in [(own.as_str(), "http://evil.example"), ("evil.example", "http://evil.example")] {
        let headers = format!("Host: {host}\r\nOrigin: {origin}\r\n");
        assert_eq!(answer(web.request("POST", "/selftest/stop", &headers)).0, 403, "{headers}");
    }
    assert_eq!(answer(web.request("GET", "/", "Host: evil.example\r\n")).0, 403);
    let (status, page) = answer(web.request("GET", "/", &format!("Host: {own}\r\n")));
    assert!(status == 200 && page.contains("<title>Tenax</title>"), "{status}");
    web.until("a bench", |event| event["bench"].is_array());
    assert_eq!(["/bench/g", "/zero", "/drive"].map(|path| web.post(path).0), [403, 403, 404]);
    web.selftest("fsr_a");
    served.end();
}

#[test]
fn a_line_alone_has_no_bench_as_on_a_real_board() {
    let served = Serving::start(BENCH);
    let web = Web::start(&["--port", &served.place, "--control"]);
    let event = web.until("the board", |event| event["t_s"].as_f64() > Some(1.0));
    assert!(event["bench"].is_null() && event["truth"].is_null());
    let (status, why) = web.post("/bench/g");
    assert!(status == 404 && why.starts_with("no bench"), "{status} {why}");
    served.end();
}
