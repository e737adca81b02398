//! `tenax monitor`: a board's serial line, or one that was captured.

use std::fs::File;
use std::io;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use anyhow::{Context, bail};
use tenax_hal_shim::setting::SettingId;
use tenax_hal_shim::wire::{BAUD, Down, SETTINGS_PER_ANSWER, Setting};

use super::out;
use crate::link::Outbox;
use crate::monitor::{End, Monitor};
use crate::settings;

/// Watch a board's serial line.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The port: /dev/ttyACM0, COM3, ...
    #[arg(long, value_name = "PORT", required_unless_present = "file", conflicts_with = "file")]
    port: Option<String>,
    /// A captured line instead, such as out/line.bin of `tenax run`
    #[arg(long, value_name = "FILE")]
    file: Option<PathBuf>,
    /// First ask the board for something, or tell it something; may be given more than once
    #[arg(long, value_name = "COMMAND", requires = "port")]
    send: Vec<Send>,
    /// Change a setting, such as s1-mv=120; may be given more than once
    #[arg(long, requires = "port", value_name = "NAME=VALUE", value_parser = |text: &str| settings::parse(text))]
    set: Vec<Setting>,
    /// Ask for a setting; may be given more than once
    #[arg(long, requires = "port", value_name = "NAME", value_parser = |name: &str| settings::named(name))]
    get: Vec<SettingId>,
    /// Ask for every setting
    #[arg(long, requires = "port")]
    settings: bool,
    /// Pass a camera's words on to the board, from standard input: a line `v1 v2 [age_ms]` for each picture
    #[arg(long, requires = "port")]
    teach: bool,
}

/// What can be sent by name.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Send {
    /// Ask for a sign of life
    Ping,
    /// Ask for the last sample of every channel
    Samples,
    /// Ask for the network's weights and activations
    Network,
    /// Take the readings of the unloaded finger as zero
    Zero,
    /// Save what the network has learned now
    Save,
    /// Forget all that the network has learned
    Forget,
    /// Calibrate the myosensors to the wearer: three prompts of 5 s
    CalibrateEmg,
}

impl From<Send> for Down {
    fn from(send: Send) -> Self {
        match send {
            Send::Ping => Self::Ping,
            Send::Samples => Self::Samples,
            Send::Network => Self::Network,
            Send::Zero => Self::Zero,
            Send::Save => Self::Save,
            Send::Forget => Self::Forget,
            Send::CalibrateEmg => Self::CalibrateEmg,
        }
    }
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let mut monitor = Monitor::default();
    let mut out = io::stdout().lock();
    let watched = match (&args.file, &args.port) {
        (Some(file), _) => {
            let mut source = File::open(file).with_context(|| format!("cannot open {}", file.display()))?;
            monitor.watch(&mut source, &mut out)
        }
        (None, Some(port)) => {
            let mut line = open(port)?;
            tell(args, line.as_mut(), &mut |bytes| monitor.take(bytes, &mut out))?;
            monitor.watch(line.as_mut(), &mut out)
        }
        (None, None) => bail!("give --port PORT or --file FILE"),
    };
    let end = match watched {
        // Whoever read our output has read enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(ExitCode::SUCCESS),
        other => other.context("cannot print")?,
    };
    out::note!("{}", monitor.counts());
    match (end, &args.port) {
        (End::Unplugged(error), Some(port)) => {
            bail!("{port} went away ({error}): was the board unplugged? Plug it in and start again")
        }
        (End::Over, Some(port)) => bail!("{port} was closed at its other end"),
        _ => Ok(ExitCode::SUCCESS),
    }
}

/// Sends what is to be sent at once, and lets the teacher talk beside the watching.
fn tell(
    args: &Args,
    line: &mut dyn serialport::SerialPort,
    seen: &mut dyn FnMut(&[u8]) -> io::Result<()>,
) -> anyhow::Result<()> {
    let mut outbox = Outbox::new(line.try_clone().context("cannot write to the port")?);
    let changes =
        !args.set.is_empty() || args.teach || args.send.iter().any(|&send| !Down::from(send).reads());
    if changes {
        let mut printed = Ok(());
        let mut show =
            |bytes: &[u8]| printed = std::mem::replace(&mut printed, Ok(())).and_then(|()| seen(bytes));
        let opened = outbox.open_session(line, &mut show).context("cannot open a session")?;
        printed.context("cannot print")?;
        if !opened {
            out::note!("tenax: the board offered no session; what changes something will be refused");
        }
    }
    let set = args.set.iter().map(|&setting| Down::Set(setting));
    let get = args.get.iter().map(|&id| Down::Get(id as u8));
    // The first of each part of the table that one answer has room for.
    let all = SettingId::ALL.into_iter().step_by(SETTINGS_PER_ANSWER).map(|id| Down::Settings(id as u8));
    let all = all.filter(|_| args.settings);
    for command in args.send.iter().map(|&send| send.into()).chain(set).chain(get).chain(all) {
        outbox.send(&command).context("cannot write to the port")?;
    }
    if args.teach {
        // It ends with its input, or with the process.
        std::thread::spawn(move || {
            if let Err(error) = outbox.teach(io::stdin().lock()) {
                out::note!("tenax: {error:#}; the teacher is not heard any more");
            }
        });
    }
    Ok(())
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
