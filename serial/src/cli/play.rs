//! `tenax play`: a recording's line once more, at the pace at which it was recorded; or as CSV.

use std::path::PathBuf;
use std::process::ExitCode;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::bail;
use tenax_hal_shim::wire::Up;

use super::out;
use crate::link::captured::line_of;
use crate::link::{Encoder, Inbox};
use crate::record::csv;
use crate::record::topics::seconds;
use crate::serve::{Options, Server};

/// Play a recording.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A recording (MCAP) or a captured line
    file: PathBuf,
    /// Write its values as CSV into this folder, a file a topic, and play nothing
    #[arg(long, value_name = "DIR")]
    csv: Option<PathBuf>,
    /// Serve its line on a pseudo-terminal, for `tenax monitor --port` and any other program
    #[arg(long)]
    serve: bool,
    /// Serve it on this TCP port of 127.0.0.1; 0: any that is free
    #[arg(long, value_name = "PORT")]
    serve_tcp: Option<u16>,
    /// Times as fast as it was recorded
    #[arg(long, value_name = "TIMES", default_value_t = 1.0)]
    speed: f64,
}

/// Plays a recording.
pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let line = line_of(&args.file)?;
    if let Some(folder) = &args.csv {
        for path in csv::export(&line, folder)? {
            out::note!("  {:<14}{}", "written", path.display());
        }
        return Ok(ExitCode::SUCCESS);
    }
    if !args.serve && args.serve_tcp.is_none() {
        bail!(
            "say where to: --csv DIR, --serve or --serve-tcp PORT; `tenax monitor --file` prints it at once"
        );
    }
    let (mut server, _nobody) =
        Server::start(&Options { pty: args.serve, tcp: args.serve_tcp, ..Options::default() })?;
    for place in server.places() {
        out::note!("serving on {place}");
    }
    out::note!("it begins when somebody listens; Ctrl-C ends it");
    while server.tally().clients == 0 {
        thread::sleep(Duration::from_millis(50));
    }
    let (mut inbox, mut encoder, mut last) = (Inbox::default(), Encoder::default(), None);
    let began = Instant::now();
    for heard in line.iter().filter_map(|&byte| inbox.push(byte)).flatten() {
        if let Up::Slow(slow) = &heard.received.message {
            let first = *last.get_or_insert(slow.frame);
            let due = Duration::from_secs_f64(
                (seconds(slow.frame) - seconds(first)).max(0.0) / args.speed.max(0.01),
            );
            thread::sleep(due.saturating_sub(began.elapsed()));
        }
        server.line(encoder.frame(&heard.received.message).1);
    }
    out::note!("{}; {}", inbox.counts(), server.close());
    Ok(ExitCode::SUCCESS)
}
