//! A scene that the built tool serves, and ROS 2's side of the network.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use tempfile::TempDir;

/// `tenax run --host --serve-tcp 0`, as `cargo tenax` builds it, ended with this.
pub struct Served {
    run: Child,
    pub line: String,
    _folder: TempDir,
}

impl Served {
    pub fn start(scene: &str) -> Self {
        let tool = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/release/tenax-sim");
        assert!(tool.exists(), "build the tool first: `cargo tenax run --list`");
        let folder = tempfile::tempdir().unwrap();
        let mut named = scene.to_owned();
        if scene.contains('\n') {
            let file = folder.path().join("served.toml");
            std::fs::write(&file, scene).unwrap();
            named = file.display().to_string();
        }
        let mut run = Command::new(tool)
            .args(["run", "--host", "--serve-tcp", "0", "--scene", &named, "--out"])
            .arg(folder.path())
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut said = BufReader::new(run.stderr.take().unwrap());
        let mut line = String::new();
        said.read_line(&mut line).unwrap();
        let line = line.trim_end().split_once(" on ").unwrap_or_else(|| panic!("{line}")).1.to_owned();
        // It goes on saying how far it is.
        std::thread::spawn(move || said.lines().for_each(drop));
        Self { run, line, _folder: folder }
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ended = self.run.kill();
        let _waited = self.run.wait();
    }
}
