//! Who has a serial port open.

use std::fmt::{self, Display};
use std::path::Path;

/// A process.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Holder {
    /// Its number.
    pub pid: u32,
    /// What it is called, if that is known.
    pub name: String,
}

impl Display for Holder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "process {} ({})", self.pid, self.name)
    }
}

/// Another process that has the port open. None as well where the system, or another user's process, does not tell.
pub fn of(port: &Path) -> Option<Holder> {
    let port = port.canonicalize().ok()?;
    let processes = std::fs::read_dir("/proc").ok()?;
    processes.flatten().find_map(|process| {
        let pid: u32 = process.file_name().to_str()?.parse().ok()?;
        let mut files = std::fs::read_dir(process.path().join("fd")).ok()?.flatten();
        let is_held = pid != std::process::id()
            && files.any(|file| std::fs::read_link(file.path()).is_ok_and(|path| path == port));
        let name = || std::fs::read_to_string(process.path().join("comm")).unwrap_or_default();
        is_held.then(|| Holder { pid, name: name().trim().to_owned() })
    })
}
