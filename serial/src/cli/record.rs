//! `tenax record`: a board's line into an MCAP file.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use tenax_hal_shim::wire::Down;

use super::{out, port};
use crate::link::{Client, LastSeconds, Target};
use crate::record::{Recording, topics};
use crate::words::in_words;

/// The board streams for as long after each time that it is asked.
const HOLD_S: u16 = 5;

/// Record a board's line.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Where the line is [default: the only board that is plugged in]
    #[arg(long, value_name = "PORT")]
    port: Option<Target>,
    /// The recording
    #[arg(long, value_name = "FILE.mcap", default_value = "tenax.mcap")]
    out: PathBuf,
    /// End after so many seconds [default: Ctrl-C, or the end of the line]
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// Leave out the frames, which take three fifths of the line; then it cannot be replayed
    #[arg(long)]
    no_frames: bool,
    /// Instead, what the board still has of the seconds before its last run ended in a fault. It then keeps it no longer
    #[arg(long, conflicts_with_all = ["seconds", "no_frames"])]
    last: bool,
}

const EXAMPLES: &str = "\
Examples:
  tenax record --out walk.mcap                 until Ctrl-C, with every frame: it can be replayed
  tenax record --seconds 60 --no-frames        a minute of what was decided, a fifth of the line
  tenax record --last --out fault.mcap         the board has restarted: what it did in the seconds before
  tenax plot fault.mcap                        draws any of them";

/// Records until it is to end.
pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let target = port::or_found(args.port.as_ref())?;
    let mut client = Client::open(&target)?;
    if args.last {
        return last(&mut client, &args.out);
    }
    let mut recording = Recording::create(&args.out)?;
    let stopped = Arc::new(AtomicBool::new(false));
    signal_hook::flag::register(signal_hook::consts::SIGINT, Arc::clone(&stopped))
        .context("cannot listen for Ctrl-C")?;
    if client.can_send() {
        client.send(&Down::About)?;
    }
    let began = Instant::now();
    let mut asked: Option<Instant> = None;
    let is_over = || {
        stopped.load(Relaxed) || args.seconds.is_some_and(|seconds| began.elapsed().as_secs_f64() >= seconds)
    };
    while !is_over() {
        if client.can_send() && asked.is_none_or(|at| at.elapsed().as_secs() >= u64::from(HOLD_S) / 2) {
            client.send(&Down::Stream { raw: !args.no_frames, senses: true, hold_s: HOLD_S })?;
            asked = Some(Instant::now());
        }
        match client.next_message() {
            Ok(Some(heard)) => recording.take(&heard.received),
            Ok(None) => {}
            Err(_) => break,
        }
    }
    recording.finish().with_context(|| format!("cannot write {}", args.out.display()))?;
    let lasted = Duration::from_secs(began.elapsed().as_secs());
    out::note!("{} in {lasted:?}, written to {}", client.counts(), args.out.display());
    Ok(ExitCode::SUCCESS)
}

/// What the board keeps of a run that ended in a fault.
fn last(client: &mut Client, path: &Path) -> anyhow::Result<ExitCode> {
    let Some(kept) = LastSeconds::fetch(client)? else {
        bail!(
            "the board keeps nothing: its last run did not end in a fault, it was switched off since, or somebody has fetched it"
        );
    };
    let mut recording = Recording::create(path)?;
    recording.line(&kept.line);
    recording.finish().with_context(|| format!("cannot write {}", path.display()))?;
    // Only now that it is in a file.
    LastSeconds::let_go(client)?;
    let span = kept.span().map_or_else(String::new, |(from, to)| {
        let (from_s, to_s) = (topics::seconds(from), topics::seconds(to));
        format!(", {:.2} s, from {from_s:.2} to {to_s:.2} s", to_s - from_s)
    });
    out::note!(
        "before {}{}: {} bytes{span}, written to {}",
        in_words(&kept.after),
        if kept.why.is_empty() { String::new() } else { format!(" ({})", kept.why) },
        kept.line.len(),
        path.display()
    );
    Ok(ExitCode::SUCCESS)
}
