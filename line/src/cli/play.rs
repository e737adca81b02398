//! `tenax play`: a recording's line once more, at the pace at which it was recorded; or as CSV.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

use anyhow::bail;
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::wire::Up;

use tenax_frames::link::Encoder;
use tenax_frames::link::captured::line_of;
use tenax_frames::play::{Playing, Reel, SPEEDS, Told, play};
use tenax_frames::record::csv;
use tenax_frames::serve::{Options, Server};
use tenax_frames::tool::out;

const EXAMPLES: &str = "\
Examples:
  tenax play hand.mcap --csv tables            CSV files in the folder tables
  tenax play hand.mcap --serve --speed 2       serves the line at twice its speed
`tenax monitor --file FILE` plays a recording on the page, which scrubs, loops and pauses it.";

/// Play a recording.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// A recording (MCAP) or a captured line
    file: PathBuf,
    /// Write the values as CSV files into this folder, one for each topic, instead of playing
    #[arg(long, value_name = "DIR")]
    csv: Option<PathBuf>,
    /// Serve the line on a pseudo-terminal, for `tenax monitor --port` and any other program
    #[arg(long)]
    serve: bool,
    /// Serve the line on this TCP port of 127.0.0.1; 0: any free port
    #[arg(long, value_name = "PORT")]
    serve_tcp: Option<u16>,
    /// Speed as a multiple of real time, such as 2
    #[arg(long, value_name = "TIMES", default_value_t = 1.0)]
    speed: f64,
    /// Begin at this second of the recording
    #[arg(long, value_name = "S", default_value_t = 0.0)]
    from: f64,
    /// Play again and again until Ctrl-C
    #[arg(long = "loop")]
    repeat: bool,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    if let Some(folder) = &args.csv {
        for path in csv::export(&line_of(&args.file)?, folder)? {
            out::note!("  {:<14}{}", "written", path.display());
        }
        return Ok(ExitCode::SUCCESS);
    }
    let reel = Reel::open(&args.file)?;
    if !args.serve && args.serve_tcp.is_none() {
        bail!(
            "say where to: --csv DIR, --serve or --serve-tcp PORT; `tenax monitor --file` shows it, and --plain prints it at once"
        );
    }
    let (mut server, _nobody) =
        Server::start(&Options { pty: args.serve, tcp: args.serve_tcp, ..Options::default() })?;
    for place in server.places() {
        out::note!("serving on {place}");
    }
    out::note!("{:.1} s; it begins when somebody listens; Ctrl-C ends it", reel.length_s());
    while server.tally().clients == 0 {
        thread::sleep(Duration::from_millis(50));
    }
    let (_none, controls) = channel();
    let speed = args.speed.clamp(SPEEDS.0, SPEEDS.1);
    let playing = Playing { at_s: args.from, speed, repeat: args.repeat, ..Playing::new(&reel) };
    let (mut encoder, mut messages) = (Encoder::default(), 0_u64);
    play(&reel, playing, &controls, &mut |told| {
        match told {
            Told::Message(heard) => {
                messages += 1;
                server.line(encoder.frame(&heard.received.message).1);
            }
            // For a client, time begins anew.
            Told::Again => {
                server.line(encoder.frame(&Up::Hello { frame_hz: FRAME_HZ as u16, after: None }).1);
            }
            Told::At(_) => {}
            Told::Over => return false,
        }
        true
    });
    out::note!("{messages} messages; {}", server.close());
    Ok(ExitCode::SUCCESS)
}
