//! `tenax monitor`: a board's serial line, or one that was captured.

use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, bail};
use tenax_hal_shim::setting::SettingId;
use tenax_hal_shim::wire::{Down, SETTINGS_PER_ANSWER, Setting};

use super::out;
use crate::link::{Line, Outbox, Target};
use crate::monitor::{End, Monitor};
use crate::settings;

/// Watch a board's serial line.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Where the line is: /dev/ttyACM0, COM3, /dev/pts/5, tcp:127.0.0.1:7777, or a file with a captured one
    #[arg(long, value_name = "PORT", required_unless_present = "file")]
    port: Option<Target>,
    /// A captured line, such as out/glass.line.bin of `tenax run`
    #[arg(long, value_name = "FILE", conflicts_with = "port")]
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
    let target = match (&args.port, &args.file) {
        (Some(port), _) => port.clone(),
        (None, Some(file)) => Target::File(file.clone()),
        (None, None) => bail!("give --port PORT or --file FILE"),
    };
    let mut line = target.open()?;
    tell(args, &mut line, &mut |bytes| monitor.take(bytes, &mut out))?;
    let end = match monitor.watch(&mut line.up, &mut out) {
        // Whoever read our output has read enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(ExitCode::SUCCESS),
        other => other.context("cannot print")?,
    };
    out::note!("{}", monitor.counts());
    match (end, &target) {
        (End::Over, Target::File(_)) => Ok(ExitCode::SUCCESS),
        (End::Over, _) => bail!(target.after_end(None)),
        (End::Unplugged(error), _) => bail!(target.after_end(Some(&error))),
    }
}

/// Sends what is to be sent at once, and lets the teacher talk beside the watching.
fn tell(args: &Args, line: &mut Line, seen: &mut dyn FnMut(&[u8]) -> io::Result<()>) -> anyhow::Result<()> {
    let set = args.set.iter().map(|&setting| Down::Set(setting));
    let get = args.get.iter().map(|&id| Down::Get(id as u8));
    // The first of each part of the table that one answer has room for.
    let all = SettingId::ALL.into_iter().step_by(SETTINGS_PER_ANSWER).map(|id| Down::Settings(id as u8));
    let all = all.filter(|_| args.settings);
    let commands: Vec<Down> =
        args.send.iter().map(|&send| send.into()).chain(set).chain(get).chain(all).collect();
    let Some(down) = line.down.take() else {
        if args.teach || !commands.is_empty() {
            bail!("a captured line cannot be told anything: give a port, or tcp:HOST:PORT");
        }
        return Ok(());
    };
    let mut outbox = Outbox::new(down);
    if args.teach || commands.iter().any(|command| !command.reads()) {
        let mut printed = Ok(());
        let mut show =
            |bytes: &[u8]| printed = std::mem::replace(&mut printed, Ok(())).and_then(|()| seen(bytes));
        let opened = outbox.open_session(&mut line.up, &mut show).context("cannot open a session")?;
        printed.context("cannot print")?;
        if !opened {
            out::note!("tenax: the board offered no session; what changes something will be refused");
        }
    }
    for command in commands {
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
