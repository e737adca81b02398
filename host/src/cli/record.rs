//! `tenax record`: a board's line into an MCAP file.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

use anyhow::Context;
use tenax_hal_shim::wire::Down;

use super::{out, port};
use crate::link::{Client, Target};
use crate::record::Recording;

/// The board streams for as long after each time that it is asked.
const HOLD_S: u16 = 5;

/// Record a board's line.
#[derive(Debug, clap::Args)]
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
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let target = port::or_found(args.port.as_ref())?;
    let mut client = Client::open(&target)?;
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
