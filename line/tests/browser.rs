//! A headless Chromium, told what to do through a pair of pipes (its DevTools protocol).

use std::collections::VecDeque;
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};

use serde_json::{Value, json};
use tempfile::TempDir;

/// A page in a browser of its own.
pub struct Page {
    browser: Child,
    to: File,
    from: BufReader<File>,
    session: Option<String>,
    number: u64,
    /// What the page's scripts threw and what it logged as errors.
    pub errors: VecDeque<String>,
    _folder: TempDir,
}

impl Page {
    /// Opens a page in the browser that the build script found.
    pub fn open(url: &str) -> Self {
        let chromium = option_env!("CHROMIUM").unwrap_or("chromium");
        let folder = tempfile::tempdir().unwrap();
        let [to, from] = ["to", "from"].map(|name| folder.path().join(name));
        assert!(Command::new("mkfifo").args([&to, &from]).status().unwrap().success());
        // It reads from 3 and writes to 4. What it says of its own troubles is nothing to us.
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
        // Each waits for the other end, in the shell's order.
        let to = File::options().write(true).open(to).unwrap();
        let from = BufReader::new(File::open(from).unwrap());
        let errors = VecDeque::new();
        let mut page = Self { browser, to, from, session: None, number: 0, errors, _folder: folder };
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
    pub fn value(&mut self, expression: &str) -> Value {
        let asked = json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let answer = self.ask("Runtime.evaluate", asked);
        assert!(answer.get("exceptionDetails").is_none(), "{expression}: {answer}");
        answer["result"]["value"].clone()
    }

    /// Makes its window as large as this, in pixels.
    pub fn size(&mut self, width: u32, height: u32) {
        let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 800 });
        self.ask("Emulation.setDeviceMetricsOverride", size);
    }

    /// Writes its picture, as a PNG in base64, where `TENAX_PICTURE` says, with this after the name; else nowhere.
    pub fn picture(&mut self, name: &str) {
        let Ok(path) = std::env::var("TENAX_PICTURE") else { return };
        let shot = self.ask("Page.captureScreenshot", json!({ "format": "png" }));
        std::fs::write(path + name, shot["data"].as_str().unwrap()).unwrap();
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
            match heard["method"].as_str() {
                Some("Runtime.exceptionThrown") => self.errors.push_back(heard["params"].to_string()),
                Some("Runtime.consoleAPICalled") if heard["params"]["type"] == "error" => {
                    self.errors.push_back(heard["params"].to_string());
                }
                _ => {}
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
