//! The place of a board's line: a serial port, a pseudo-terminal, a TCP address or a file.

use std::fmt::{self, Display};
use std::io::{self, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::Duration;

use anyhow::{Context, anyhow, bail};
use tenax_hal_shim::wire::BAUD;

use super::captured::line_of;

/// Of a port that only root and the group of serial ports may open.
const PERMISSION: &str = "you may not: `sudo usermod -aG dialout $USER` (on Arch: uucp) and a new login let you, or a udev rule \
                          with MODE=\"0666\"";
const READ_TIMEOUT: Duration = Duration::from_millis(100);
const CONNECT_TIMEOUT: Duration = Duration::from_secs(3);

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// A serial port or a pseudo-terminal: `/dev/ttyACM0`, `COM3`, `/dev/pts/5`.
    Port(String),
    Tcp(String),
    File(PathBuf),
}

pub struct Line {
    /// What comes up. A read that finds nothing for 0.1 s fails with `TimedOut` or `WouldBlock`; a file ends.
    pub up: Box<dyn Read + Send>,
    /// Where commands go. None for a captured line.
    pub down: Option<Box<dyn Write + Send>>,
}

impl FromStr for Target {
    type Err = String;

    /// A regular file is a captured line; anything else that is no `tcp:` is a port.
    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(address) = text.strip_prefix("tcp:") {
            let (host, port) = address.rsplit_once(':').unwrap_or_default();
            return match port.parse::<u16>() {
                Ok(_) if !host.is_empty() => Ok(Self::Tcp(address.to_owned())),
                _ => Err("write tcp:HOST:PORT, such as tcp:127.0.0.1:7777".to_owned()),
            };
        }
        let path = Path::new(text);
        Ok(if path.is_file() { Self::File(path.to_owned()) } else { Self::Port(text.to_owned()) })
    }
}

impl Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Port(name) => f.write_str(name),
            Self::Tcp(address) => write!(f, "tcp:{address}"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

impl Target {
    pub fn open(&self) -> anyhow::Result<Line> {
        match self {
            Self::Port(name) => open_port(name),
            Self::Tcp(address) => connect(address).with_context(|| {
                format!("cannot connect to {self}: is `tenax run --serve-tcp` running there?")
            }),
            Self::File(path) => Ok(Line { up: Box::new(io::Cursor::new(line_of(path)?)), down: None }),
        }
    }
}

fn open_port(name: &str) -> anyhow::Result<Line> {
    // A pseudo-terminal that is opened exclusively stays locked when its client is killed. A real port is for one alone: two
    // would each get half of the bytes.
    let pseudo = is_pseudo(name);
    if holder(name).is_some() {
        // A served run opens it for an instant, to drop what its last client has not read.
        std::thread::sleep(READ_TIMEOUT);
    }
    if let Some(holder) = holder(name) {
        bail!(
            "another program reads {name}: {holder}. Two would each get half of the bytes: end it first, or serve on \
             TCP (--serve-tcp), where each client hears everything"
        );
    }
    let baud = if pseudo && cfg!(target_os = "macos") { 0 } else { BAUD };
    let port = serialport::new(name, baud).timeout(READ_TIMEOUT).exclusive(!pseudo);
    let both = port.open().and_then(|up| Ok((up.try_clone()?, up)));
    let (down, up) = both.map_err(|error| {
        let what = match error.kind {
            serialport::ErrorKind::Io(io::ErrorKind::PermissionDenied) => PERMISSION.to_owned(),
            _ => format!(
                "ports on this machine: {}. A scene's line is where `tenax run --serve` says, or tcp:HOST:PORT",
                port_names()
            ),
        };
        anyhow!(error).context(format!("cannot open {name}; {what}"))
    })?;
    Ok(Line { up: Box::new(up), down: Some(Box::new(down)) })
}

/// Serial ports of this machine, for an error's words.
pub fn port_names() -> String {
    let ports = serialport::available_ports().unwrap_or_default();
    let names: Vec<String> = ports.into_iter().map(|port| port.port_name).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

/// Another process that has a port open. None as well where the system, or another user's process, does not tell.
fn holder(port: &str) -> Option<String> {
    let port = Path::new(port).canonicalize().ok()?;
    std::fs::read_dir("/proc").ok()?.flatten().find_map(|process| {
        let pid: u32 = process.file_name().to_str()?.parse().ok()?;
        let mut files = std::fs::read_dir(process.path().join("fd")).ok()?.flatten();
        let is_held = pid != std::process::id()
            && files.any(|file| std::fs::read_link(file.path()).is_ok_and(|path| path == port));
        let name = || std::fs::read_to_string(process.path().join("comm")).unwrap_or_default();
        is_held.then(|| format!("process {pid} ({})", name().trim()))
    })
}

fn is_pseudo(name: &str) -> bool {
    let path = std::fs::canonicalize(name).unwrap_or_default();
    path.starts_with("/dev/pts")
        || (cfg!(target_os = "macos") && path.to_string_lossy().starts_with("/dev/ttys"))
}

fn connect(address: &str) -> io::Result<Line> {
    let mut failed = io::Error::from(io::ErrorKind::AddrNotAvailable);
    for address in address.to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, CONNECT_TIMEOUT) {
            Ok(up) => {
                up.set_nodelay(true)?;
                up.set_read_timeout(Some(READ_TIMEOUT))?;
                let down = up.try_clone()?;
                return Ok(Line { up: Box::new(up), down: Some(Box::new(down)) });
            }
            Err(error) => failed = error,
        }
    }
    Err(failed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_told_by_how_it_is_written_and_an_error_says_what_to_do() {
        for right in ["tcp:127.0.0.1:7777", "tcp:[::1]:7777"] {
            let target: Target = right.parse().unwrap();
            assert!(matches!(target, Target::Tcp(_)) && target.to_string() == right);
        }
        for wrong in ["tcp:", "tcp:7777", "tcp::7777", "tcp:host:", "tcp:host:70000"] {
            assert!(wrong.parse::<Target>().unwrap_err().contains("tcp:HOST:PORT"), "{wrong}");
        }
        let file = tempfile::NamedTempFile::new().unwrap();
        assert_eq!(file.path().to_str().unwrap().parse(), Ok(Target::File(file.path().to_owned())));
        let error = |text: &str| format!("{:#}", text.parse::<Target>().unwrap().open().err().unwrap());
        assert!(error("/dev/no-such-port").contains("ports on this machine: "));
        // Nobody listens on port 1.
        assert!(error("tcp:127.0.0.1:1").contains("is `tenax run --serve-tcp` running there?"));
    }
}
