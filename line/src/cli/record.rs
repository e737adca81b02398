//! `tenax record`: a board's line into an MCAP file.

use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use tenax_hal_shim::wire::{Answer, Down, Setting, Up};
use tenax_logic::setting::SettingId;

use super::port;
use tenax_frames::link::{ANSWER_WITHIN, Client, LastSeconds, Target};
use tenax_frames::record::{self, Recording};
use tenax_frames::tool::out;
use tenax_frames::words::in_words;

/// The board streams for as long after each time that it is asked.
const HOLD_S: u16 = 5;
/// How soon a setting is in flash: settings are saved every 3 s at most.
const SAVED_WITHIN: Duration = Duration::from_secs(4);

/// Record a board's line.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Serial line: /dev/ttyACM0, COM3, /dev/pts/5 or tcp:127.0.0.1:7777 [default: the only board that is plugged in]
    #[arg(long, value_name = "PORT")]
    port: Option<Target>,
    /// The recording, a new file [default: tenax- and the time, in this folder]
    #[arg(long, value_name = "FILE.mcap")]
    out: Option<PathBuf>,
    /// Length, s [default: until Ctrl-C or the end of the line]
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// Leave out the frames, three fifths of the bytes; `tenax run --replay` then cannot replay it
    #[arg(long)]
    no_frames: bool,
    /// For hours: no frames, and only the topics /line, /state (20 a second), /event, /counters and /setting. `tenax play
    /// --csv` restores the other topics
    #[arg(long, conflicts_with = "no_frames")]
    compact: bool,
    /// Begin at the board's next start, so that `tenax run --replay` can replay the recording: sets stream-at-start-flag, then
    /// waits until somebody presses the board's reset button
    #[arg(long, conflicts_with_all = ["no_frames", "compact", "last"])]
    from_start: bool,
    /// Fetch the last 2 to 3 s before a fault from the board instead; the board then deletes them
    #[arg(long, conflicts_with_all = ["seconds", "no_frames", "compact"])]
    last: bool,
}

const EXAMPLES: &str = "\
Examples:
  tenax record --out walk.mcap                 until Ctrl-C, with every frame
  tenax record --seconds 60 --no-frames        a minute of decisions, without frames
  tenax record --compact                       less than 60 MB an hour
  tenax record --last --out fault.mcap         after a fault: the seconds before the restart
  tenax plot fault.mcap                        draws any of them

  tenax record --from-start --out fault.mcap   from the board's reset on, for `tenax run --replay`";

/// Records until it is to end.
pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let target = port::or_found(args.port.as_ref())?;
    let mut client = Client::open(&target)?;
    let path = args.out.clone().unwrap_or_else(record::name_now);
    if args.last {
        return last(&mut client, &path);
    }
    let from_start = args.from_start || offer(&client, args)?;
    let mut recording = if args.compact { Recording::compact(&path) } else { Recording::create(&path) }?;
    if from_start {
        stream_at_start(&mut client)?;
    }
    let stopped = Arc::new(AtomicBool::new(false));
    signal_hook::flag::register(signal_hook::consts::SIGINT, Arc::clone(&stopped))
        .context("cannot listen for Ctrl-C")?;
    if client.can_send() && !from_start {
        client.send(&Down::About)?;
    }
    let mut began = Instant::now();
    let mut waits = from_start;
    let mut asked: Option<Instant> = None;
    let (mut joined, mut progress) = (Joined::default(), Progress::new(began));
    let is_over = |began: Instant| {
        stopped.load(Relaxed) || args.seconds.is_some_and(|seconds| began.elapsed().as_secs_f64() >= seconds)
    };
    while waits && !stopped.load(Relaxed) || !is_over(began) {
        if !waits
            && client.can_send()
            && asked.is_none_or(|at| at.elapsed().as_secs() >= u64::from(HOLD_S) / 2)
        {
            client.send(&Down::Stream {
                raw: !args.no_frames && !args.compact,
                senses: true,
                hold_s: HOLD_S,
            })?;
            asked = Some(Instant::now());
        }
        match client.next_message() {
            Ok(Some(heard)) if waits && !matches!(heard.received.message, Up::Hello { .. }) => {}
            Ok(Some(heard)) => {
                if std::mem::take(&mut waits) {
                    out::note!("the board has started: recording");
                    (began, asked, progress) =
                        (Instant::now(), Some(Instant::now()), Progress::new(Instant::now()));
                }
                joined.take(&heard.received.message);
                recording.take(&heard.received);
            }
            Ok(None) => {}
            Err(_) => break,
        }
        progress.show(|| format!("{}, {} kB", client.counts(), recording.bytes() / 1_000));
    }
    progress.end();
    recording.finish().with_context(|| format!("cannot write {}", path.display()))?;
    let lasted = Duration::from_secs(began.elapsed().as_secs());
    out::note!("{} in {lasted:?}, written to {}", client.counts(), path.display());
    Ok(ExitCode::SUCCESS)
}

/// Whether a person wants to begin with the board's next start: asked where somebody can answer.
fn offer(client: &Client, args: &Args) -> anyhow::Result<bool> {
    if args.no_frames || args.compact || !client.can_send() || !io::stdin().is_terminal() {
        return Ok(false);
    }
    out::note!(
        "From now on, it can be watched, plotted and exported; from the board's start on, replayed, too. Restart the board \
         for that? [y/N]"
    );
    let mut answer = String::new();
    io::stdin().read_line(&mut answer)?;
    Ok(answer.trim().eq_ignore_ascii_case("y"))
}

/// Has the board stream from its start on, and asks for that. Fails if it does not let itself be set.
fn stream_at_start(client: &mut Client) -> anyhow::Result<()> {
    let setting = Setting { id: SettingId::StreamAtStart.number(), value: 1 };
    if client.ask(&Down::Get(setting.id), ANSWER_WITHIN)? != Answer::Setting(setting) {
        super::config::set(client, setting)?;
        // Or the board would not know it after its start.
        let began = Instant::now();
        while began.elapsed() < SAVED_WITHIN {
            client.next_message().context("the line ended")?;
        }
    }
    out::note!("Press the board's black reset button (at a served bench, type `reset` with Enter).");
    Ok(())
}

/// Where in the board's run the recording begins: before its start, or too late for a replay, which is said once.
#[derive(Default)]
struct Joined {
    is_known: bool,
}

impl Joined {
    fn take(&mut self, message: &Up) {
        let frame = match message {
            Up::Hello { .. } => Some(0),
            Up::Raw(raw) => Some(raw.first),
            _ => None,
        };
        if !self.is_known && frame.is_some_and(|frame| frame > 0) {
            out::note!(
                "it begins {:.1} s after the board's start: it can be watched, plotted and exported, but not replayed. For one \
                 that can be: tenax record --from-start",
                tenax_frames::words::seconds(frame.unwrap_or(0))
            );
        }
        self.is_known |= frame.is_some();
    }
}

/// How far it is: each second on a terminal, every ten seconds in a log.
struct Progress {
    began: Instant,
    every: Duration,
    shown: Duration,
}

impl Progress {
    fn new(began: Instant) -> Self {
        let every = Duration::from_secs(if io::stderr().is_terminal() { 1 } else { 10 });
        Self { began, every, shown: Duration::ZERO }
    }

    fn show(&mut self, what: impl Fn() -> String) {
        let now = self.began.elapsed();
        if now < self.shown + self.every {
            return;
        }
        self.shown = now;
        let line = format!("{:4} s: {}", now.as_secs(), what());
        if self.every.as_secs() == 1 { eprint!("\r{line} ") } else { out::note!("{line}") }
    }

    fn end(&self) {
        if self.every.as_secs() == 1 && !self.shown.is_zero() {
            eprintln!();
        }
    }
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
        let (from_s, to_s) = (tenax_frames::words::seconds(from), tenax_frames::words::seconds(to));
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
