//! A scene that the tool serves, as a person starts it.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStderr, Command, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// `tenax run --host --serve-tcp 0`, and where it serves.
pub struct Serving {
    run: Child,
    said: BufReader<ChildStderr>,
    /// In the order in which it says them.
    pub places: Vec<String>,
    /// Where it writes what a run leaves.
    pub folder: TempDir,
}

impl Serving {
    /// Serves a scene file's text at one place more than `more` asks for.
    pub fn start(scene: &str, more: &[&str]) -> Self {
        Self::at(scene, more, 1 + more.len())
    }

    /// Serves it on TCP, and tells the truth at a second place.
    pub fn start_telling(scene: &str) -> Self {
        Self::at(scene, &["--serve-truth", "0"], 2)
    }

    /// Serves it again and again, as a board that can be reset.
    pub fn looping(scene: &str) -> Self {
        Self::at(scene, &["--loop"], 1)
    }

    fn at(scene: &str, more: &[&str], places: usize) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("served.toml");
        std::fs::write(&path, scene).unwrap();
        let mut run = Command::new(env!("CARGO_BIN_EXE_tenax-host"))
            .args(["run", "--host", "--serve-tcp", "0", "--scene"])
            .arg(path)
            .args(more)
            .arg("--out")
            .arg(folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut said = BufReader::new(run.stderr.take().unwrap());
        let place = |_| {
            let mut line = String::new();
            said.read_line(&mut line).unwrap();
            let place = line.trim_end().split_once(" on ").unwrap_or_else(|| panic!("{line}")).1;
            place.to_owned()
        };
        let places = (0..places).map(place).collect();
        Self { run, said, places, folder }
    }

    /// Serves a board that trusts its line, so that nobody at the hand has to consent.
    pub fn trusting() -> Self {
        let rig = include_str!("../../../scenes/rig.toml");
        Self::start(&rig.replacen("\n[contact]", "\nline_trusted = true\n\n[contact]", 1), &[])
    }

    /// Somebody at the bench does this.
    pub fn tell(&mut self, line: &str) {
        writeln!(self.run.stdin.as_mut().unwrap(), "{line}").unwrap();
    }

    /// Ends the run now.
    pub fn kill(&mut self) {
        self.run.kill().unwrap();
        self.run.wait().unwrap();
    }

    /// Waits for the run's end; what else it said.
    pub fn end(mut self) -> Vec<String> {
        self.wait()
    }

    /// Waits for the run's end; its report.
    pub fn report(mut self) -> Value {
        self.wait();
        let path = self.folder.path().join("served.json");
        serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
    }

    fn wait(&mut self) -> Vec<String> {
        let rest = self.said.by_ref().lines().map(Result::unwrap).collect();
        assert!(self.run.wait().unwrap().success());
        rest
    }
}
