//! `tenax play`: a recording's line once more, at the pace at which it was recorded; or as CSV.

use std::path::PathBuf;
use std::process::ExitCode;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::bail;
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::wire::Up;

use super::out;
use crate::link::captured::line_of;
use crate::link::{Counts, Encoder, Inbox};
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
    /// Begin so many seconds after the recording's beginning
    #[arg(long, value_name = "S", default_value_t = 0.0)]
    from: f64,
    /// When it is over, play it again; Ctrl-C ends it
    #[arg(long = "loop")]
    repeat: bool,
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
    let mut encoder = Encoder::default();
    let counts = loop {
        let counts = play(&line, args, &mut |message| server.line(encoder.frame(message).1));
        if !args.repeat {
            break counts;
        }
        // Who watches has to know that time begins anew.
        server.line(encoder.frame(&Up::Hello { frame_hz: FRAME_HZ as u16, after: None }).1);
    };
    out::note!("{counts}; {}", server.close());
    Ok(ExitCode::SUCCESS)
}

/// Says each message when it is due; before the beginning only what stays so: who the board is, and its settings.
fn play(line: &[u8], args: &Args, say: &mut dyn FnMut(&Up)) -> Counts {
    let mut inbox = Inbox::default();
    let (mut first, mut played) = (None, None);
    for heard in line.iter().filter_map(|&byte| inbox.push(byte)).flatten() {
        let message = &heard.received.message;
        if let Up::Slow(slow) = message {
            let at_s = seconds(slow.frame);
            let from_s = *first.get_or_insert(at_s) + args.from;
            if at_s >= from_s {
                let (began, begin_s) = *played.get_or_insert((Instant::now(), at_s));
                let due = Duration::from_secs_f64((at_s - begin_s).max(0.0) / args.speed.max(0.01));
                thread::sleep(due.saturating_sub(began.elapsed()));
            }
        }
        let stays = matches!(message, Up::Hello { .. } | Up::About(_) | Up::Answer { .. });
        if played.is_some() || stays || args.from <= 0.0 {
            say(message);
        }
    }
    inbox.counts()
}
