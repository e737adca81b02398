//! The page of `tenax monitor`, over its HTTP: what it is told, and what it asks for.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Map, Value};

use crate::selftest::fault;
use crate::serving::{BENCH, Serving, command};

const WITHIN: Duration = Duration::from_secs(60);

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

    pub fn watching(served: &Serving, more: &[&str]) -> Self {
        Self::start(&[&["--port", &served.place], more].concat())
    }

    fn place(&self) -> &str {
        self.url.trim_start_matches("http://").trim_end_matches('/')
    }

    fn request(&self, method: &str, path: &str, headers: &str) -> TcpStream {
        let mut stream = TcpStream::connect(self.place()).unwrap();
        write!(stream, "{method} {path} HTTP/1.1\r\n{headers}Connection: close\r\n\r\n").unwrap();
        stream
    }

    pub fn ask(&self, method: &str, path: &str) -> TcpStream {
        let place = self.place();
        self.request(method, path, &format!("Host: {place}\r\nOrigin: http://{place}\r\n"))
    }

    pub fn post(&self, path: &str) -> (u16, String) {
        answer(self.ask("POST", path))
    }

    pub fn events(&self) -> impl Iterator<Item = Value> + use<> {
        let lines = BufReader::new(self.ask("GET", "/events")).lines().map(Result::unwrap);
        let batch = |line: String| serde_json::from_str(line.strip_prefix("data: ")?).unwrap();
        let changes = lines.filter_map(batch).flat_map(|batch: Vec<Map<String, Value>>| batch);
        changes.scan(Map::new(), |state, change| {
            state.extend(change);
            Some(Value::Object(state.clone()))
        })
    }

    pub fn until(&self, what: &str, mut is_so: impl FnMut(&Value) -> bool) -> Value {
        let began = Instant::now();
        let is_found = |event: &Value| {
            assert!(began.elapsed() < WITHIN, "never {what}: {}", event["line"]);
            is_so(event)
        };
        self.events().find(is_found).expect("the page stays open")
    }

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
    web.until("the board", |event| event["t_s"].is_number());
    assert_eq!(web.post("/selftest/skip").0, 409);
    web.selftest("fsr/array_2/array_3");
    assert!(web.post("/selftest/start/nonsense").1.starts_with("no channel begins with `nonsense`"));

    let (mut answered, mut loudest) = (0, 0.0_f64);
    let test = web.until("an end of the test", |event| {
        let test = &event["selftest"];
        let lines = test["lines"].as_array().map_or(&[][..], Vec::as_slice);
        for line in lines.iter().skip(answered).map(|line| line.as_str().unwrap()) {
            match line.split([' ', ',']).collect::<Vec<_>>()[..] {
                ["press", "fsr_c", ..] => assert_eq!(web.post("/selftest/skip").0, 202),
                ["press", channel, ..] => {
                    assert_eq!(test["prompt"], line, "what is asked is shown");
                    served.tell(&format!("press {channel}"));
                }
                _ => {}
            }
        }
        answered = lines.len();
        let level = &test["level"];
        let part = |level: &Value| Some(level["moved_mv"].as_f64()? / level["needed_mv"].as_f64()?);
        loudest = loudest.max(part(level).unwrap_or(0.0));
        test["over"] == true
    });
    let test = &test["selftest"];
    let said: Vec<&str> =
        test["lines"].as_array().unwrap().iter().map(|line| line.as_str().unwrap()).collect();
    let text = said.join("\n");
    for words in [
        "array_2 (switch B, 1) and array_3 (switch B, 2): exchange their wires",
        "fsr_b (switch A, 13): 0 mV: a cut wire",
        "fsr_c (switch A, 14): left out, not tested",
    ] {
        assert!(text.contains(words), "{text}");
    }
    assert!(text.ends_with("2 of 6 channels pass"), "{text}");
    assert!(loudest > 1.5 && test["passes"] == false, "the live level shows the touch: {loudest}");
    let row = |name: &str| test["results"].as_array().unwrap().iter().find(|row| row[0] == name).unwrap();
    let passes = ["fsr_a", "fsr_c", "fsr_d", "array_2"].map(|name| row(name)[2].as_bool());
    assert_eq!(passes, [Some(true), None, Some(true), Some(false)]);
    assert!(row("array_2")[3].as_str().unwrap().starts_with("array_3 (switch B, 2) moves in its place"));

    // A board that is gone ends the next test.
    web.selftest("fsr_a");
    served.end();
    let event = web.until("an end", |event| event["selftest"]["failed"].is_string());
    assert!(event["selftest"]["failed"].as_str().unwrap().starts_with("the line is gone"), "{event:#}");
    assert_eq!((web.post("/selftest/start").0, web.post("/selftest/stop").0), (409, 202));
    web.until("closed", |event| event["selftest"].is_null());
}

#[test]
fn the_page_shows_consent_and_changes_a_setting() {
    let served = Serving::start(BENCH);
    let web = Web::watching(&served, &["--control"]);
    // As it is switched on it has consent for a minute; a press gives the whole minute anew.
    let left_s = |event: &Value| -> u32 {
        let digits = event["line"].as_str().unwrap_or_default().replace(|c: char| !c.is_ascii_digit(), "");
        digits.parse().unwrap_or(0)
    };
    web.until("less consent", |event| (1..57).contains(&left_s(event)));
    served.tell("button");
    web.until("consent", |event| left_s(event) > 58);
    assert_eq!(web.post("/set/s1-mv/120").0, 202);
    web.until("the setting", |event| event["s1_mv"] == 120);
    served.end();
}

#[test]
fn only_pages_of_this_address_may_ask_and_without_control_they_change_nothing() {
    let served = Serving::start(BENCH);
    let web = Web::watching(&served, &[]);
    let own = web.place().to_owned();
    let status = |method, path, headers: &str| answer(web.request(method, path, headers)).0;
    for host in [own.as_str(), "evil.example"] {
        let headers = format!("Host: {host}\r\nOrigin: http://evil.example\r\n");
        assert_eq!(status("POST", "/selftest/stop", &headers), 403, "{headers}");
    }
    assert_eq!(status("GET", "/", "Host: evil.example\r\n"), 403);
    assert_eq!(status("GET", "/", &format!("Host: {own}\r\n")), 200);
    web.until("the board", |event| event["t_s"].is_number());
    let posts = |paths: &[&str]| paths.iter().map(|path| web.post(path).0).collect::<Vec<_>>();
    assert_eq!(posts(&["/zero", "/calibrate", "/set/s1-mv/120"]), [403; 3]);
    assert_eq!(
        posts(&["/drive", "/bench/g", "/play/g%0ao", "/set/s1-mv", "/set/s1/120", "/set/s1-mv/x", "/"]),
        [404; 7]
    );
    web.selftest("fsr_a");
    served.end();
}
