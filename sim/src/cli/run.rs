//! `tenax run`: a scene or a recording on a board; report and figure.

use std::fs;
use std::io::{self, BufWriter, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::thread;

use anyhow::Context;
use clap::ArgGroup;
use tenax_hal_shim::channel;
use tenax_scene::act::KEYS;
use tenax_scene::{SceneFile, builtin};

use crate::again;
use crate::board::Recorder;
use crate::live::{Live, Person, Use};
use crate::plot::sheet::draw;
use crate::replay::{self, muscles};
use crate::report::text::Text;
use crate::session::{self, Board};
use tenax_frames::link::captured::is_recording;
use tenax_frames::record::Recording;
use tenax_frames::serve::{self, Down, Server};
use tenax_frames::tool::folder;
use tenax_frames::tool::format::Format;
use tenax_frames::tool::progress::Progress;
use tenax_frames::tool::{out, stop, workspace};

const EXAMPLES: &str = "\
Examples:
  tenax run                                 the default scene on the emulated board, with the flashed image
  tenax run --list                          what there is to run
  tenax run --host --scene knocks           another scene, on the host's build of the logic
  tenax run --host --controls               beside no reflex, a constant grip and each detector alone
  tenax run --replay touch.csv              a recording, with the recipe that its name calls for
  tenax run --replay my.csv --recipe my.toml
  tenax run --replay my.csv --explain       what its columns and times are taken for
  tenax run --replay my.csv --suggest-recipe > my.toml
  tenax run --report json > report.json     for programs
  tenax run --serve                         at real time, with its serial line on a pseudo-terminal
  tenax run --host --serve-tcp 7777         on TCP port 7777 of this machine only
  tenax run --record grasp.mcap             its line, for `run --replay grasp.mcap`";

/// Run a scene or a recording on a board; report and draw it.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
#[command(group(ArgGroup::new("served").args(["serve", "serve_tcp"]).multiple(true)))]
pub struct Args {
    /// Run the PC's own build of the logic: no image, no emulator
    #[arg(long)]
    host: bool,
    /// List the scenes and end
    #[arg(long)]
    list: bool,
    /// A scene file, or the name of one that `--list` shows
    #[arg(long, value_name = "FILE.toml|NAME", default_value = session::DEFAULT_SCENE, conflicts_with = "replay")]
    scene: String,
    /// Play a recording instead of a scene: voltages at the pins (CSV), or a recorded line (MCAP) into the PC's logic
    #[arg(long, value_name = "RECORDING.csv|FILE.mcap")]
    replay: Option<PathBuf>,
    /// Recipe that maps the recording's columns to pins: a file, or a name in recipes/ [default: by the recording's name]
    #[arg(long, value_name = "FILE.toml|NAME", requires = "replay")]
    recipe: Option<String>,
    /// Print what the recording's columns, times and first rows are taken for, and end
    #[arg(long, requires = "replay")]
    explain: bool,
    /// Print a recipe to begin with, by how the recording's table looks, and end
    #[arg(long, requires = "replay", conflicts_with_all = ["recipe", "explain"])]
    suggest_recipe: bool,
    /// First calibrate the myosensors with these three recordings [default: not calibrated]
    #[arg(long, value_name = "REST.csv,CLOSE.csv,OPEN.csv", value_delimiter = ',', requires = "replay")]
    calibrate_emg: Option<Vec<PathBuf>>,
    /// Also run the scene's controls on the PC: no reflex, a constant grip of the same mean force, each detector alone, all but one
    #[arg(long, conflicts_with = "replay")]
    controls: bool,
    /// Seed of every noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How to print the report
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
    /// Folder for the figure, the report (JSON) and the serial line's bytes
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Run at real time and serve the line on a pseudo-terminal, for `tenax monitor --port` and any other program
    #[arg(long)]
    serve: bool,
    /// Make a symlink to the pseudo-terminal
    #[arg(long, value_name = "PATH", requires = "serve")]
    serve_at: Option<PathBuf>,
    /// Run at real time and serve the line on this TCP port of 127.0.0.1; 0: any free port
    #[arg(long, value_name = "PORT")]
    serve_tcp: Option<u16>,
    /// Repeat the scene, each time with the next seed, until Ctrl-C
    #[arg(long = "loop", conflicts_with_all = ["replay", "record", "controls"], requires = "served")]
    repeat: bool,
    /// Record the line with every frame, for `run --replay FILE.mcap`
    #[arg(long, value_name = "FILE.mcap")]
    record: Option<PathBuf>,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    if args.list {
        return list();
    }
    if let Some(recording) = args.replay.as_deref().filter(|path| is_recording(path)) {
        let outcome = again::replay(recording)?;
        out::say!("{outcome}")?;
        return Ok(ExitCode::from(u8::from(outcome.difference.is_some())));
    }
    if let (true, Some(path)) = (args.suggest_recipe, &args.replay) {
        out::print(format_args!("{}", replay::suggest::suggest(path)?))?;
        return Ok(ExitCode::SUCCESS);
    }
    if let (true, Some(path)) = (args.explain, &args.replay) {
        let (recording, named) = replay::library::read(path, args.recipe.as_deref())?;
        let goes_to = |column: &str| match &named {
            Some(named) => named.recipe.goes_to(column),
            None => channel::by_name(column).map_or(String::new(), |_| column.to_owned()),
        };
        out::print(format_args!("{}", recording.explained(&goes_to)))?;
        return Ok(ExitCode::SUCCESS);
    }
    let folder = folder::made(&args.out)?;
    // What is to be run is looked at before the image is built, which can take minutes.
    let subject = match &args.replay {
        Some(path) => Subject::Recording(path, replay::library::read(path, args.recipe.as_deref())?.0),
        None => Subject::Scene(Box::new(session::load_scene(&args.scene)?)),
    };
    // A scene's name is no file's: it may have a point, as in `a-0.3`.
    let stem = match &subject {
        Subject::Recording(path, _) => path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        Subject::Scene(file) => file.name.replace(['/', '\\'], "-"),
    };
    let path = |extension: &str| folder.join(format!("{stem}.{extension}"));
    let board = if args.host { Board::Host } else { Board::emulated(&workspace::root()?)? };
    let (mut server, down) = served(args)?.unzip();
    let person = Person::default();
    if server.is_some() {
        listen(&person, resets(args));
    }
    let live = || down.as_ref().map(|down| Live::new(down.clone(), person.clone()));
    if let (true, Subject::Scene(file), Some(server)) = (args.repeat, &subject, &mut server) {
        return again_and_again(file, args.seed, &board, server, &person, &live);
    }
    let stop = stop::on_signals()?;
    let recording = args.record.as_deref().map(Recording::create).transpose()?;
    let mut kept = Kept::create(path("line.bin"), recording, Arc::clone(&stop))?;
    let line_use = Use { live: live(), streams_at_start: args.record.is_some(), stop, ..Use::default() };
    let mut no_server = ();
    let to_server = server.as_mut().map_or::<&mut dyn Recorder, _>(&mut no_server, |own| own);
    let recorder = &mut (&mut kept, to_server);
    let run = || match &subject {
        Subject::Recording(file, recording) => {
            let progress = Progress::new("replay", recording.duration_s());
            let (recipe, seed) = (args.recipe.as_deref(), args.seed);
            let calibrate = |recordings: &Vec<PathBuf>| muscles::calibrate_by(recordings, recipe, seed);
            let wearer = (recipe, args.calibrate_emg.as_ref().map(calibrate).transpose()?);
            session::replay_served(file, wearer, line_use, seed, &board, recorder, &mut |s| progress.at(s))
        }
        Subject::Scene(file) => {
            let progress = Progress::new(&format!("scene {}", file.name), file.duration_s());
            let mut outcome =
                session::scene_served(file, args.seed, &board, line_use, recorder, &mut |s| progress.at(s))?;
            if args.controls {
                outcome.report.controls = session::controls::controls(file, args.seed, &outcome.truth);
            }
            Ok(outcome)
        }
    };
    let outcome = run();
    let mut files = kept.close(args.record.as_deref())?;
    if let Some(server) = server {
        out::note!("  {:<14}{}", "served", server.close());
    }
    let outcome = outcome?;
    let svg = draw::svg(&outcome.figure)?.into_bytes();
    for (extension, bytes) in [("svg", svg), ("json", serde_json::to_vec_pretty(&outcome.report)?)] {
        let path = path(extension);
        fs::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
        files.push(path);
    }
    args.report.print(&Text(&outcome.report), &outcome.report)?;
    // On stderr, so that a program that reads the report reads nothing else.
    for file in files {
        out::note!("  {:<14}{}", "written", file.display());
    }
    Ok(ExitCode::SUCCESS)
}

fn list() -> anyhow::Result<ExitCode> {
    for (name, text) in builtin() {
        let scene = SceneFile::parse(text, &format!("scenes/{name}.toml"))?;
        let (duration_s, title, from) = (scene.duration_s(), &scene.title, &scene.from);
        out::say!("{name:<20} {duration_s:>4.0} s  {title}\n{:<28} from {from}", "")?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Begins to serve, if that is asked for, and says where.
fn served(args: &Args) -> anyhow::Result<Option<(Server, Down)>> {
    if !args.serve && args.serve_tcp.is_none() {
        return Ok(None);
    }
    let options = serve::Options { pty: args.serve, at: args.serve_at.clone(), tcp: args.serve_tcp };
    let (server, down) = Server::start(&options)?;
    for place in server.places() {
        out::note!("serving on {place}");
    }
    Ok(Some((server, down)))
}

/// The lines that press the blue button and the black one. What the board's flash keeps it has again afterwards.
const BUTTON: &str = "button";
const RESET: &str = "reset";

/// Whether the board can be reset: another run follows, and the host's board keeps its flash.
const fn resets(args: &Args) -> bool {
    args.repeat && args.host
}

/// Does what a person at the keyboard types, or what a program pipes, such as the prompts of `tenax selftest`.
fn listen(person: &Person, resets: bool) {
    let is_typed = io::stdin().is_terminal();
    if is_typed {
        out::note!("Enter alone: press the blue button (consent for a minute)");
        let keys = KEYS.map(|(key, what, _)| format!("{key} {what}"));
        out::note!("with Enter: {},\n{}", keys[..4].join(", "), keys[4..].join(", "));
        out::note!("`weight 5` lays 5 N on the finger, `tap pvdf_3` taps a film");
        if resets {
            out::note!("`{RESET}`: press the board's reset button");
        }
    }
    let own = person.clone();
    let does = move |line: String| match line.as_str() {
        "" if is_typed => own.press(),
        line if !act(&own, line, resets) && is_typed => out::note!("no key: {line}"),
        // A program says other things, too.
        _ => {}
    };
    // They end with the process.
    thread::spawn(move || io::stdin().lines().map_while(Result::ok).for_each(does));
}

/// Does at the bench what a line says. False: it says nothing that can be done.
fn act(person: &Person, line: &str, resets: bool) -> bool {
    match line.parse() {
        Ok(act) => person.act(act),
        Err(()) if line == BUTTON => person.press(),
        Err(()) if line == RESET && resets => person.reset(),
        Err(()) => return false,
    }
    true
}

/// One run after the other on the same served line, until somebody ends the process.
fn again_and_again(
    file: &SceneFile,
    seed: u64,
    board: &Board,
    server: &mut Server,
    person: &Person,
    live: &dyn Fn() -> Option<Live>,
) -> anyhow::Result<ExitCode> {
    for seed in seed.. {
        let line = Use { live: live(), without_bound: true, ..Use::default() };
        let outcome = session::scene_served(file, seed, board, line, server, &mut |_| {})?;
        let fate = if outcome.truth.dropped { "DROPPED" } else { "kept" };
        let how = if person.lets_go() { "is reset" } else { "is switched on anew" };
        out::note!("{}, seed {seed}: {fate}; the board {how}", file.name);
    }
    Ok(ExitCode::SUCCESS)
}

/// Files that the line goes to as it comes. An error ends the run.
struct Kept {
    path: PathBuf,
    line: BufWriter<fs::File>,
    recording: Option<Recording>,
    stop: Arc<AtomicBool>,
    error: Option<anyhow::Error>,
}

impl Kept {
    fn create(path: PathBuf, recording: Option<Recording>, stop: Arc<AtomicBool>) -> anyhow::Result<Self> {
        let file = fs::File::create(&path).with_context(|| format!("cannot write {}", path.display()))?;
        Ok(Self { path, line: BufWriter::new(file), recording, stop, error: None })
    }

    fn cannot(&self) -> String {
        format!("cannot write {}", self.path.display())
    }

    fn write(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.line.write_all(bytes).with_context(|| self.cannot())?;
        self.recording.as_mut().map_or(Ok(()), |recording| recording.line(bytes))
    }

    /// Ends the files, of a run that was stopped too. Fails if one could not be written.
    fn close(mut self, recorded: Option<&Path>) -> anyhow::Result<Vec<PathBuf>> {
        self.error.take().map_or(Ok(()), Err)?;
        self.line.flush().with_context(|| self.cannot())?;
        self.recording.map_or(Ok(()), Recording::finish)?;
        Ok(recorded.map(Path::to_owned).into_iter().chain([self.path]).collect())
    }
}

impl Recorder for Kept {
    fn line(&mut self, bytes: &[u8]) {
        if self.error.is_none()
            && let Err(error) = self.write(bytes)
        {
            self.error = Some(error);
            self.stop.store(true, Relaxed);
        }
    }
}

enum Subject<'a> {
    Recording(&'a Path, replay::Recording),
    Scene(Box<SceneFile>),
}
