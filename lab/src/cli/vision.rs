//! `tenax vision`: a camera behind the skin.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use anyhow::{Context, bail};
use tenax_frames::link::{Client, Outbox, Target};
use tenax_frames::tool::{folder, format::Format, out};
use tenax_hal_shim::wire::{Answer, Down, Up};
use tenax_hal_shim::words::Code;

use crate::vision::film::{self, Plan, Source};
use crate::vision::scored;

/// Load from which on a hand holds something, mN.
const HOLDS_MN: i32 = 200;

const EXAMPLES: &str = "\
Examples:
  tenax vision                                         drawn sessions, scored against their truth
  tenax vision --report json                           for programs
  tenax vision --video skin.m4v --out seen             markers.csv and object.csv of a video
  tenax vision --device /dev/video0 --teach /dev/ttyACM0
                                                       a board's Hebbian network learns slip from a camera";

/// Follow skin and object with a camera behind a clear skin.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// A video file, which ffmpeg decodes
    #[arg(long, value_name = "FILE", group = "source")]
    video: Option<PathBuf>,
    /// A camera of Video4Linux, such as /dev/video0
    #[arg(long, value_name = "DEVICE", group = "source")]
    device: Option<PathBuf>,
    /// Pictures a second of a video, Hz
    #[arg(long, value_name = "HZ", default_value_t = 30.0)]
    rate_hz: f64,
    /// Folder for markers.csv and object.csv
    #[arg(long, value_name = "FOLDER", requires = "source")]
    out: Option<PathBuf>,
    /// Send the teacher's codes to this board: /dev/ttyACM0 or tcp:127.0.0.1:7777. Only one program can send on a line
    #[arg(long, value_name = "PORT", requires = "source")]
    teach: Option<Target>,
    /// Seed of the drawn scenes
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of drawn sessions
    #[arg(long, value_name = "N", default_value_t = 3)]
    sessions: u64,
    /// How to report
    #[arg(long, value_enum, default_value = "text")]
    report: Format,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let source = match (&args.video, &args.device) {
        (Some(file), _) => Source::Video(file.clone()),
        (_, Some(device)) => Source::Device(device.clone()),
        _ if args.sessions == 0 => bail!("--sessions must be at least 1"),
        _ => {
            args.report.show(&scored::score(args.seed, args.sessions)?)?;
            return Ok(ExitCode::SUCCESS);
        }
    };
    if !(args.rate_hz > 0.0 && args.rate_hz.is_finite()) {
        bail!("--rate-hz must be above 0");
    }
    let plan = Plan {
        source,
        rate_hz: args.rate_hz,
        folder: args.out.as_deref().map(folder::made).transpose()?,
        live: args.teach.is_some(),
    };
    let holds = Arc::new(AtomicBool::new(false));
    let mut board = args.teach.as_ref().map(|port| open(port, holds.clone())).transpose()?;
    let report = film::follow(&plan, &holds, |summary, age_ms| {
        if let (Some(board), Some((v1, v2))) = (&mut board, summary.codes()) {
            let codes = [v1, v2].map(|code| Code::from_sign(code.into()));
            board.send(&Down::Teach { codes, age_ms }).context("cannot write to the line")?;
        }
        Ok(())
    })?;
    args.report.show(&report)?;
    Ok(ExitCode::SUCCESS)
}

/// Opens a line and reads it from now on, so that it does not fill; `holds` becomes whether the board's hand holds something. Fails if it
/// cannot be opened or is a captured one.
fn open(target: &Target, holds: Arc<AtomicBool>) -> anyhow::Result<Outbox<Box<dyn Write + Send>>> {
    let mut client = Client::open(target)?;
    if !client.open_session(Duration::from_secs(1))? {
        out::note!("tenax: the board offered no session; it will not listen to the camera");
    }
    let line = client.take_outbox().context("nothing can be sent to a captured line")?;
    std::thread::spawn(move || {
        let (mut was_open, mut is_refused) = (false, false);
        while let Ok(frame) = client.next_frame() {
            let Some(Ok(heard)) = frame else { continue };
            match heard.received.message {
                Up::Slow(slow) => {
                    let held = slow.forces.is_some_and(|forces| forces.load_mn > HOLDS_MN);
                    was_open |= slow.forces.is_some() && !held;
                    // An object that is held from the start has to be learned in the hand.
                    holds.store(held && was_open, Ordering::Relaxed);
                }
                Up::Answer { answer: Answer::Refused(why), .. } if !is_refused => {
                    is_refused = true;
                    out::note!("tenax: the board refuses the camera's codes: {why:?}");
                }
                _ => (),
            }
        }
    });
    Ok(line)
}
