//! `tenax record`: a board's line into an MCAP file.

use std::io;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::Ordering::Relaxed;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use tenax_hal_shim::wire::{Answer, Down, Setting, Up};
use tenax_logic::setting::SettingId;

use super::port::{self, Line};
use tenax_frames::link::{ANSWER_WITHIN, Board, Client};
use tenax_frames::record::{self, Recording};
use tenax_frames::tool::progress::Progress;
use tenax_frames::tool::{out, stop};
use tenax_frames::words::seconds;

const AGAIN_AFTER: Duration = Duration::from_millis(300);
/// Settings are saved every 3 s at most.
const SAVED_WITHIN: Duration = Duration::from_secs(4);

/// Record a board's line.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    line: Line,
    /// The recording, a new file [default: tenax- and the time, in this folder]
    #[arg(long, value_name = "FILE.mcap")]
    out: Option<PathBuf>,
    /// Length, s [default: until Ctrl-C]
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// Begin at the board's next start, so that `tenax run --replay` can replay the recording: sets stream-at-start-flag, then
    /// waits until somebody presses the board's reset button
    #[arg(long)]
    from_start: bool,
}

const EXAMPLES: &str = "\
Examples:
  tenax record --out walk.mcap                 until Ctrl-C, with every frame
  tenax plot walk.mcap                         draws it
  tenax record --from-start --out whole.mcap   from the board's reset on, for `tenax run --replay`";

/// Records until the time is over or a signal comes, and goes on when a line that ended is back. Fails if it is not back by then:
/// what came is recorded.
pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let mut board = Board::at(port::or_found(args.line.port.as_ref())?);
    let (mut client, _) = board.open()?;
    let path = args.out.clone().unwrap_or_else(record::name_now);
    let mut recording = Recording::create(&path)?;
    if args.from_start {
        stream_at_start(&mut client)?;
    }
    let stopped = stop::on_signals()?;
    let status = Progress::new("record", 1.0);
    let (mut began, mut waits, mut is_joined, mut end) = (Instant::now(), args.from_start, false, None);
    let is_over = |began: Instant| args.seconds.is_some_and(|s| began.elapsed().as_secs_f64() >= s);
    while end.is_none() && !stopped.load(Relaxed) && (waits || !is_over(began)) {
        // What cannot be asked of a line has ended it.
        let asked = if waits { Ok(()) } else { client.keep_streaming(true).map_err(io::Error::other) };
        match asked.and_then(|()| client.next_message()) {
            Ok(Some(heard)) if waits && !matches!(heard.received.message, Up::Hello { .. }) => {}
            Ok(Some(heard)) => {
                if std::mem::take(&mut waits) {
                    status.clear();
                    out::note!("the board has started: recording");
                    began = Instant::now();
                }
                let first = match &heard.received.message {
                    Up::Hello { .. } => Some(0),
                    Up::Raw(raw) => Some(raw.first),
                    _ => None,
                };
                if let Some(frame @ 1..) = first.filter(|_| !is_joined) {
                    status.clear();
                    out::note!(
                        "it begins {:.1} s after the board's start: it can be watched, plotted and exported, but not \
                         replayed. For one that can be: tenax record --from-start",
                        seconds(frame)
                    );
                }
                is_joined |= first.is_some();
                recording.take(&heard.received)?;
            }
            Ok(None) => {}
            Err(error) if !client.can_send() => end = Some(error),
            Err(error) => {
                let (lost, after_s) = (Instant::now(), began.elapsed().as_secs_f64());
                status.clear();
                out::note!("the line ended after {after_s:.1} s, unasked ({error}): waiting for the board");
                match again(&mut board, || !stopped.load(Relaxed) && !is_over(began)) {
                    None => end = Some(error),
                    Some((again, moved)) => {
                        out::note!("it is back after {:.1} s", lost.elapsed().as_secs_f64());
                        moved.into_iter().for_each(|words| out::note!("{words}"));
                        let before = std::mem::replace(&mut client, again).counts();
                        client.count_on(before);
                    }
                }
            }
        }
        recording.keep()?;
        status.say(|_| client.counts().to_string());
    }
    recording.finish()?;
    status.clear();
    out::note!("{}, written to {}", client.counts(), path.display());
    // A captured line has an end.
    match end.filter(|_| client.can_send()) {
        None => Ok(ExitCode::SUCCESS),
        Some(end) => bail!("the line ended after {:.1} s, unasked ({end})", began.elapsed().as_secs_f64()),
    }
}

/// Opens the board's line once it is back, and says where it has moved. None if it is not back while one `waits`.
fn again(board: &mut Board, waits: impl Fn() -> bool) -> Option<(Client, Option<String>)> {
    while waits() {
        match board.open() {
            Ok(opened) => return Some(opened),
            Err(_) => thread::sleep(AGAIN_AFTER),
        }
    }
    None
}

/// Has the board stream from its start on, and asks for that. Fails if it does not let itself be set.
fn stream_at_start(client: &mut Client) -> anyhow::Result<()> {
    let setting = Setting { id: SettingId::StreamAtStart.number(), value: 1 };
    if client.ask(&Down::Get(setting.id), ANSWER_WITHIN)? != Answer::Setting(setting) {
        super::config::set(client, &[setting])?;
        let began = Instant::now();
        while began.elapsed() < SAVED_WITHIN {
            client.next_message().context("the line ended")?;
        }
    }
    out::note!("Press the board's black reset button (at a served bench, type `reset` with Enter).");
    Ok(())
}
