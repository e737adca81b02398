//! The option `--port`, and the only board that is plugged in, where none is named.

use anyhow::bail;
use tenax_frames::link::board::plugged_in;
use tenax_frames::link::{Client, Target, port_names};

#[derive(Debug, clap::Args)]
pub struct Line {
    /// Serial line: /dev/ttyACM0, COM3, /dev/pts/5 or tcp:127.0.0.1:7777 [default: the only board that is plugged in]
    #[arg(long, value_name = "PORT", global = true)]
    pub port: Option<Target>,
}

impl Line {
    pub fn open(&self) -> anyhow::Result<Client> {
        Client::open(&or_found(self.port.as_ref())?)
    }
}

/// The line that was named, or that of the only board. Fails if there is none or there are several: names the ports.
pub fn or_found(named: Option<&Target>) -> anyhow::Result<Target> {
    if let Some(target) = named {
        return Ok(target.clone());
    }
    let boards = plugged_in();
    match &boards[..] {
        [only] => Ok(Target::Port(only.clone())),
        [] => bail!(
            "no board is plugged in; serial ports on this machine: {}. Name one with --port, or a scene's line, which \
             `tenax run --serve` prints",
            port_names()
        ),
        _ => bail!("several boards are plugged in: name one with --port: {}", boards.join(", ")),
    }
}
