//! `tenax monitor`: a board's serial line, or one that was captured.

use std::fs::File;
use std::io;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use anyhow::{Context, bail};
use tenax_hal_shim::wire::BAUD;

use crate::monitor::{End, Monitor};

/// Watch a board's serial line.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The port: /dev/ttyACM0, COM3, ...
    #[arg(long, value_name = "PORT", required_unless_present = "file", conflicts_with = "file")]
    port: Option<String>,
    /// A captured line instead, such as out/line.bin of `tenax run`
    #[arg(long, value_name = "FILE")]
    file: Option<PathBuf>,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let mut monitor = Monitor::default();
    let mut out = io::stdout().lock();
    let watched = match (&args.file, &args.port) {
        (Some(file), _) => {
            let mut source = File::open(file).with_context(|| format!("cannot open {}", file.display()))?;
            monitor.watch(&mut source, &mut out)
        }
        (None, Some(port)) => monitor.watch(open(port)?.as_mut(), &mut out),
        (None, None) => bail!("give --port PORT or --file FILE"),
    };
    let end = match watched {
        // Whoever read our output has read enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(ExitCode::SUCCESS),
        other => other.context("cannot print")?,
    };
    eprintln!("{}", monitor.counts());
    match (end, &args.port) {
        (End::Unplugged(error), Some(port)) => {
            bail!("{port} went away ({error}): was the board unplugged? Plug it in and start again")
        }
        (End::Over, Some(port)) => bail!("{port} was closed at its other end"),
        _ => Ok(ExitCode::SUCCESS),
    }
}

fn open(port: &str) -> anyhow::Result<Box<dyn serialport::SerialPort>> {
    // The timeout only decides how often the wait for bytes begins anew.
    serialport::new(port, BAUD).timeout(Duration::from_millis(100)).open().map_err(|error| {
        let ports = serialport::available_ports().unwrap_or_default();
        let names: Vec<String> = ports.into_iter().map(|port| port.port_name).collect();
        let seen = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        anyhow::anyhow!("cannot open {port}: {error}; ports on this machine: {seen}")
    })
}
