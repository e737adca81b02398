//! The page in a headless Chromium, driven through a pair of pipes (its DevTools protocol).

use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tempfile::TempDir;
use tenax_logic::setting::SettingId;

use crate::page::Web;
use crate::selftest::fault;
use crate::serving::{BENCH, Serving};

const WITHIN: Duration = Duration::from_secs(40);

struct Page {
    browser: Child,
    to: File,
    from: BufReader<File>,
    session: Option<String>,
    number: u64,
    /// Exceptions and console errors of the page's scripts.
    errors: Vec<String>,
    _folder: TempDir,
}

impl Page {
    /// Opens a page in the browser that the build script found.
    fn open(url: &str) -> Self {
        let chromium = option_env!("CHROMIUM").unwrap_or("chromium");
        let folder = tempfile::tempdir().unwrap();
        let [to, from] = ["to", "from"].map(|name| folder.path().join(name));
        assert!(Command::new("mkfifo").args([&to, &from]).status().unwrap().success());
        // It reads from 3 and writes to 4.
        let browser = Command::new("sh")
            .args(["-c", "exec \"$@\" 3<\"$TO\" 4>\"$FROM\"", "sh", chromium])
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe"])
            .args(["--no-first-run", "--window-size=1400,1000"])
            .arg(format!("--user-data-dir={}", folder.path().join("profile").display()))
            .arg("about:blank")
            .env("TO", &to)
            .env("FROM", &from)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let to = File::options().write(true).open(to).unwrap();
        let from = BufReader::new(File::open(from).unwrap());
        let mut page =
            Self { browser, to, from, session: None, number: 0, errors: Vec::new(), _folder: folder };
        let target = page.ask("Target.createTarget", json!({ "url": "about:blank" }));
        let attached =
            page.ask("Target.attachToTarget", json!({ "targetId": target["targetId"], "flatten": true }));
        page.session = attached["sessionId"].as_str().map(str::to_owned);
        page.ask("Runtime.enable", json!({}));
        page.ask("Page.enable", json!({}));
        page.ask("Page.navigate", json!({ "url": url }));
        page
    }

    /// The value of an expression in the page.
    fn value(&mut self, expression: &str) -> Value {
        let asked = json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let answer = self.ask("Runtime.evaluate", asked);
        assert!(answer.get("exceptionDetails").is_none(), "{expression}: {answer}");
        answer["result"]["value"].clone()
    }

    fn until(&mut self, condition: &str) {
        let began = Instant::now();
        // What the page has not loaded yet throws.
        let asked = format!("(() => {{ try {{ return {condition} }} catch {{ return false }} }})()");
        while self.value(&asked) != true {
            let text = "document.body.innerText";
            assert!(began.elapsed() < WITHIN, "never: {condition}\n{}", self.value(text));
            thread::sleep(Duration::from_millis(50));
        }
    }

    fn ask(&mut self, method: &str, params: Value) -> Value {
        self.number += 1;
        let mut message = json!({ "id": self.number, "method": method, "params": params });
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        self.to.write_all(format!("{message}\0").as_bytes()).unwrap();
        loop {
            let mut bytes = Vec::new();
            assert!(self.from.read_until(0, &mut bytes).unwrap() > 0, "the browser ended");
            bytes.pop();
            let heard: Value = serde_json::from_slice(&bytes).unwrap();
            let is_error =
                heard["method"] == "Runtime.consoleAPICalled" && heard["params"]["type"] == "error";
            if is_error || heard["method"] == "Runtime.exceptionThrown" {
                self.errors.push(heard["params"].to_string());
            }
            if heard["id"] == self.number {
                assert!(heard.get("error").is_none(), "{method}: {heard}");
                return heard["result"].clone();
            }
        }
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        let _gone = self.browser.kill();
        let _gone = self.browser.wait();
    }
}

#[test]
#[cfg_attr(not(chromium), ignore = "no Chromium here: TENAX_CHROMIUM names one that is not on PATH")]
fn a_person_sees_the_board_sets_a_setting_tests_wires_and_grips_in_the_page() {
    let served = Serving::start(&format!("line_trusted = true\n{BENCH}{}", fault("fsr_b", "dead", "")));
    let web = Web::watching(&served, &["--control"]);
    let mut page = Page::open(&web.url);
    page.until("at('mode').textContent !== '-' && points.length > 40 && last.rates !== null");
    page.until(&format!("document.querySelectorAll('#settings tr').length === {}", SettingId::ALL.len()));
    assert_eq!(page.value("document.querySelectorAll('#detectors tr').length"), 5);
    page.until("[...document.querySelectorAll('.knobs')].every(row => row.childElementCount > 2)");
    page.value(
        "(() => { const input = document.querySelector('#settings input'); input.value = 120; \
         input.dispatchEvent(new Event('change')); return true; })()",
    );
    page.until("at('log').textContent.includes('> s1-mv = 120 mV') && last.s1_mv === 120");
    page.value("at('undo').click()");
    page.until("last.s1_mv === 100");

    page.value("(() => { at('of').value = 'fsr_a fsr_b'; at('start').click(); return true; })()");
    page.until("at('prompt').textContent.startsWith('press fsr_a (') && !at('touch').hidden");
    page.value("at('touch').click()");
    page.until("at('level').value > 1 && at('levels').textContent.includes('a touch is')");
    page.until("at('prompt').textContent === '1 of 2 channels pass' && at('prompt').className === 'bad'");
    assert_eq!(page.value("[...at('results').children].map(span => span.className).join()"), "good,bad");

    page.value("document.body.dispatchEvent(new KeyboardEvent('keydown', { key: 'g', bubbles: true }))");
    page.until("last.truth.needed_n > 0 && at('truth').textContent.includes('kept')");
    assert_eq!(page.value("[last.missed, last.bad_frames].join()"), "0,0");
    served.end();
    page.until("at('gone').textContent.includes('no line, trying again')");
    assert!(page.errors.is_empty(), "{:?}", page.errors);
}
