//! `tenax vision`: cameras behind the skin.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use anyhow::{Context, bail};
use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::wire::{Answer, Down, Event, EventKind, Up};
use tenax_scene::picture::Stress;
use tenax_vision::quality::Blind;

use crate::vision::calibrate::{self, Skin};
use crate::vision::feed::Fault;
use crate::vision::film::{self, Plan, Told};
use crate::vision::source::Source;
use crate::vision::{scored, told};
use tenax_frames::link::{Client, Outbox, Target};
use tenax_frames::tool::folder;
use tenax_frames::tool::format::Format;
use tenax_frames::tool::out;

/// The load from which on a hand holds something, mN.
const HOLDS_MN: i32 = 200;

const EXAMPLES: &str = "\
Examples:
  tenax vision                                         drawn sessions, scored against their truth
  tenax vision --report json                           for programs
  tenax vision --video skin.m4v --out seen             markers.csv and object.csv of a video
  tenax vision --device /dev/video0 --port /dev/ttyACM0
                                                       a board's behaviours feel with a camera; --teach: it learns slip from it
  tenax vision --device /dev/video0 --port /dev/ttyACM0 --begin hold
                                                       and it holds with it
  tenax vision --drawn --port tcp:127.0.0.1:7777 --fault lost
                                                       the same with a drawn camera, which is lost from 4 s to 6 s
  tenax vision calibrate --loads loads.csv --leave-out 584
                                                       force from marker moves, tried on a mass that was left out";

/// Follow skin and object with a camera behind a clear skin.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, args_conflicts_with_subcommands = true)]
pub struct Args {
    #[command(subcommand)]
    command: Option<Command>,
    /// A video file, which ffmpeg decodes
    #[arg(long, value_name = "FILE", group = "source")]
    video: Option<PathBuf>,
    /// A camera of Video4Linux, such as /dev/video0
    #[arg(long, value_name = "DEVICE", group = "source")]
    device: Option<PathBuf>,
    /// A simulated camera; the scene is drawn from --seed
    #[arg(long, group = "source")]
    drawn: bool,
    /// Fault of the simulated camera from 4 s to 6 s
    #[arg(long, value_enum, value_name = "FAULT", requires = "drawn")]
    fault: Option<Fault>,
    /// Pictures a second if the source does not tell it, Hz [default: 30]
    #[arg(long, value_name = "HZ", requires = "source")]
    rate_hz: Option<f64>,
    /// Folder for markers.csv and object.csv
    #[arg(long, value_name = "FOLDER", requires = "source")]
    out: Option<PathBuf>,
    /// Send the camera's results to this board for its behaviours: /dev/ttyACM0 or tcp:127.0.0.1:7777
    #[arg(long, value_name = "PORT", requires = "source")]
    port: Option<Target>,
    /// Begin this behaviour once the camera sees the skin: gentle-grasp, hold, hand-over, or turn:DEGREES such as turn:20. Only
    /// one program can send on a line
    #[arg(long, value_name = "WHAT", requires = "port", value_parser = behaviour)]
    begin: Option<Behaviour>,
    /// Also send the teacher's codes; without --port only print them, one line a picture
    #[arg(long, requires = "source")]
    teach: bool,
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

#[derive(Debug, clap::Subcommand)]
enum Command {
    /// Calibrate force from marker motion under known loads
    Calibrate(CalibrateArgs),
}

/// Calibrate force from marker motion under known loads.
#[derive(Debug, clap::Args)]
struct CalibrateArgs {
    /// The table: image,mass_g,fx_n,fy_n,fz_n; pictures beside it or in its folder `loads`
    #[arg(long, value_name = "FILE.csv")]
    loads: PathBuf,
    /// Mass in g that is left out and used to test the calibration; may be given more than once
    #[arg(long, value_name = "G")]
    leave_out: Vec<f64>,
    /// How to report
    #[arg(long, value_enum, default_value = "text")]
    report: Format,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    if let Some(Command::Calibrate(args)) = &args.command {
        return calibrated(args);
    }
    let source = match (&args.video, &args.device) {
        (Some(file), _) => Source::Video(file.clone()),
        (_, Some(device)) => Source::Device(device.clone()),
        _ if args.drawn => Source::Drawn { seed: args.seed, rate_hz: args.rate_hz.unwrap_or(30.0) as u32 },
        _ => return drawn(args),
    };
    if args.rate_hz.is_some_and(|rate| !(rate > 0.0 && rate.is_finite())) {
        bail!("--rate-hz must be above 0");
    }
    if args.drawn && args.rate_hz.is_some_and(|rate| !(1.0..=60.0).contains(&rate) || rate.fract() != 0.0) {
        bail!("a drawn camera takes 1 to 60 pictures a second, a whole number");
    }
    let prints_codes = args.teach && args.port.is_none();
    if prints_codes && args.report == Format::Json {
        bail!("--teach without --port prints the teacher's words and no report");
    }
    let mut plan = Plan {
        source,
        rate_hz: args.rate_hz,
        folder: args.out.as_deref().map(folder::made).transpose()?,
        live: args.port.is_some() || args.device.is_some(),
        fault: args.fault,
        holds: None,
    };
    let feed = plan.open()?;
    let mut board = args.port.as_ref().map(Board::open).transpose()?;
    plan.holds = board.as_ref().map(|board| board.holds.clone());
    let (mut was_blind, mut begin) = (None, args.begin);
    let report = film::follow(&plan, feed, |told| {
        let blind = match told {
            Told::Silence(blind) => Some(blind),
            Told::Picture(camera, summary, age_ms) => {
                if let Some(board) = &mut board {
                    let view = told::view(camera, summary, told::GAINS, age_ms).map(Down::View);
                    let begins = begin.take_if(|_| view.is_some() && summary.forces.is_some());
                    let words = told::teach(summary, age_ms).filter(|_| args.teach);
                    for command in view.into_iter().chain(words).chain(begins.map(Down::Begin)) {
                        board.line.send(&command).context("cannot write to the line")?;
                    }
                } else if let Some((v1, v2)) = summary.codes().filter(|_| prints_codes) {
                    // One line a picture: v1 v2 age_ms.
                    out::say!("{v1} {v2} {age_ms}")?;
                }
                summary.blind
            }
        };
        if blind.map(name) != was_blind.map(name) {
            match blind {
                Some(blind) => out::note!("tenax: the camera is {}; nothing is sent", name(blind)),
                None => out::note!("tenax: the camera sees again"),
            }
            was_blind = blind;
        }
        Ok(())
    })?;
    if let Some(board) = board {
        // The last answers are under way.
        std::thread::sleep(Duration::from_millis(100));
        let [done, refused] = [0, 1].map(|n: usize| board.answers[n].load(Ordering::Relaxed));
        out::note!("tenax: the board took {done} messages of the camera and refused {refused}");
    }
    if !prints_codes {
        args.report.show(&report)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn behaviour(text: &str) -> Result<Behaviour, String> {
    let wrong = || "gentle-grasp, hold, hand-over or turn:DEGREES, of -90 to 90 degrees".to_owned();
    match text {
        "gentle-grasp" => Ok(Behaviour::GentleGrasp),
        "hold" => Ok(Behaviour::Hold),
        "hand-over" => Ok(Behaviour::HandOver),
        _ => {
            let degrees: f64 =
                text.strip_prefix("turn:").and_then(|own| own.parse().ok()).ok_or_else(wrong)?;
            if degrees.abs() > 90.0 {
                Err(wrong())
            } else {
                Ok(Behaviour::Turn { by_ddeg: (10.0 * degrees).round() as i16 })
            }
        }
    }
}

const fn name(blind: Blind) -> &'static str {
    match blind {
        Blind::Lost(_) => "lost",
        Blind::Late(_) => "late",
        Blind::Frozen(_) => "frozen",
        Blind::Covered => "covered",
    }
}

struct Board {
    line: Outbox<Box<dyn Write + Send>>,
    /// Whether its hand holds something.
    holds: Arc<AtomicBool>,
    /// Commands carried out, and refused.
    answers: Arc<[AtomicUsize; 2]>,
}

impl Board {
    /// Opens a line and reads it from now on, so that it does not fill. Fails if it cannot be opened or is a captured one.
    fn open(target: &Target) -> anyhow::Result<Self> {
        let mut client = Client::open(target)?;
        if !client.open_session(Duration::from_secs(1))? {
            out::note!("tenax: the board offered no session; it will not listen to the camera");
        }
        let line = client.take_outbox().context("nothing can be sent to a captured line")?;
        let holds = Arc::new(AtomicBool::new(false));
        let answers = Arc::new([AtomicUsize::new(0), AtomicUsize::new(0)]);
        let board = Self { line, holds: holds.clone(), answers: answers.clone() };
        std::thread::spawn(move || {
            let mut was_open = false;
            while let Ok(frame) = client.next_frame() {
                let Some(Ok(heard)) = frame else { continue };
                match heard.received.message {
                    Up::Slow(slow) => {
                        let held = slow.forces.is_some_and(|forces| forces.load_mn > HOLDS_MN);
                        was_open |= slow.forces.is_some() && !held;
                        // An object that is held from the start has to be learned in the hand.
                        holds.store(held && was_open, Ordering::Relaxed);
                    }
                    Up::Event(Event { kind: EventKind::Behaviour(what, ending), .. }) => {
                        let ending = ending.map_or("begun", |ending| ending.name());
                        out::note!("tenax: the board's {}: {ending}", what.name());
                    }
                    Up::Answer { answer, .. } => {
                        let refused = matches!(answer, Answer::Refused(_));
                        answers[usize::from(refused)].fetch_add(1, Ordering::Relaxed);
                    }
                    _ => (),
                }
            }
        });
        Ok(board)
    }
}

fn drawn(args: &Args) -> anyhow::Result<ExitCode> {
    if args.sessions == 0 {
        bail!("--sessions must be at least 1");
    }
    args.report.show(&scored::score(args.seed, args.sessions, Stress::default())?)?;
    Ok(ExitCode::SUCCESS)
}

fn calibrated(args: &CalibrateArgs) -> anyhow::Result<ExitCode> {
    let skin = Skin::at_rest(&args.loads)?;
    let samples = skin.samples(&args.loads)?;
    let (tried, learned) = calibrate::left_out(&samples, &args.leave_out);
    if !args.leave_out.is_empty() && tried.is_empty() {
        bail!("no load of {} has one of the masses to leave out", args.loads.display());
    }
    let loads = skin.fit(&learned)?;
    args.report.show(&calibrate::Report {
        markers: skin.markers(),
        learned: calibrate::score(&loads, &learned),
        tried: (!tried.is_empty()).then(|| calibrate::score(&loads, &tried)),
        loads: calibrate::table(&loads, &tried),
    })?;
    Ok(ExitCode::SUCCESS)
}
