//! `tenax monitor`: a board's line as a page or as lines, or one that was recorded.

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, bail};
use tenax_hal_shim::wire::{Answer, Down};

use super::port;
use crate::web::Web;
use tenax_frames::link::{ANSWER_WITHIN, Client, Heard, Target};
use tenax_frames::play::Reel;
use tenax_frames::tool::out;
use tenax_frames::words::{answer_words, why, words};

const EXAMPLES: &str = "\
Examples:
  tenax monitor                            the page, for a browser of this machine
  tenax monitor --control                  the page changes settings, too
  tenax monitor --file hand.mcap           plays a recording on the page
  tenax monitor --plain --port /dev/pts/5  one line a message, as over SSH
  tenax monitor --send network             prints the answer";

/// Watch a board's serial line.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    line: port::Line,
    /// Play a recording (MCAP), or a captured line such as out/glass.line.bin of `tenax run`, instead of a board's line
    #[arg(long, value_name = "FILE", conflicts_with = "port")]
    file: Option<PathBuf>,
    /// Print one line a message instead of serving the page, as over SSH
    #[arg(long)]
    plain: bool,
    /// TCP port of 127.0.0.1 for the page; 0: any free port
    #[arg(long, value_name = "HTTP_PORT", default_value_t = 7780, conflicts_with = "plain")]
    web: u16,
    /// Let the page change settings, zero and calibrate [default: it only watches]
    #[arg(long, conflicts_with = "plain")]
    control: bool,
    /// Send this command and print the board's answer; may be given more than once: ping, samples (of every channel), network (weights and
    /// activations), zero (the unloaded force sensor), save or forget (the weights), calibrate-emg. With --plain, watching goes on
    #[arg(long, value_name = "COMMAND", value_parser = send)]
    send: Vec<Down>,
}

fn send(name: &str) -> Result<Down, String> {
    Ok(match name {
        "ping" => Down::Ping,
        "samples" => Down::Samples,
        "network" => Down::Network,
        "zero" => Down::Zero,
        "save" => Down::Save,
        "forget" => Down::Forget,
        "calibrate-emg" => Down::CalibrateEmg,
        _ => return Err("one of ping, samples, network, zero, save, forget, calibrate-emg".to_owned()),
    })
}

/// Watches a line until it ends or the person does. 1: a command was refused.
pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let target = match &args.file {
        Some(file) => Target::File(file.clone()),
        None => port::or_found(args.line.port.as_ref())?,
    };
    if !args.plain && args.send.is_empty() {
        if let Target::File(path) = &target {
            Reel::open(path)?;
        }
        let web = Web::new(&target, args.control, args.web)?;
        out::note!("open {} in a browser of this machine; Ctrl-C ends it", web.place());
        web.serve();
        return Ok(ExitCode::SUCCESS);
    }
    let mut client = Client::open(&target)?;
    let mut refused = false;
    for command in &args.send {
        let answer = client.ask(command, ANSWER_WITHIN)?;
        refused |= matches!(answer, Answer::Refused(_));
        // Watching prints it where it comes up the line.
        if !args.plain {
            out::say!("{}", answer_words(command, &answer))?;
        }
    }
    if !args.plain {
        return Ok(ExitCode::from(u8::from(refused)));
    }
    let end = match watch(&mut client, &mut io::stdout().lock()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(ExitCode::SUCCESS),
        other => other.context("cannot print")?,
    };
    out::note!("{}", client.counts());
    match &target {
        Target::File(_) => Ok(ExitCode::SUCCESS),
        _ => {
            bail!("{target} is gone ({end}): plug the board in or start the served run again, and then this")
        }
    }
}

/// Prints messages, gaps and bad frames until the line ends; the reason. Fails if it cannot print.
pub fn watch(client: &mut Client, out: &mut dyn Write) -> io::Result<io::Error> {
    loop {
        match client.next_frame() {
            Ok(Some(Ok(Heard { received, missed }))) => {
                if missed > 0 {
                    writeln!(out, "# {missed} messages missed")?;
                }
                writeln!(out, "{:>5} {}", received.sequence, words(&received.message))?;
            }
            Ok(Some(Err(bad))) => writeln!(out, "# frame skipped: {}", why(bad))?,
            Ok(None) => out.flush()?,
            Err(end) => return out.flush().map(|()| end),
        }
    }
}
