//! `cargo tenax COMMAND`: builds the program that has the command, and starts it.
#![forbid(unsafe_code)]

mod page;

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, ExitCode};

/// A program of the workspace.
struct Program {
    manifest: &'static str,
    features: &'static [&'static str],
    commands: &'static [(&'static str, &'static str)],
}

/// By what a person meets first: try it, build a hand, study.
const PROGRAMS: [Program; 4] = [
    Program {
        manifest: "sim/Cargo.toml",
        features: &[],
        commands: &[
            ("run", "a scene or a recording on the emulated board; report and figure"),
            ("sweep", "scenes with many seeds, or drawn worlds"),
            ("plot", "draw a recording"),
        ],
    },
    Program {
        manifest: "line/Cargo.toml",
        features: &[],
        commands: &[
            ("flash", "the image onto a NUCLEO-F411RE"),
            ("selftest", "touch every sensor; names wrong wires"),
            ("monitor", "a board's line, as a page or as lines"),
            ("calibrate", "sensors and the wearer's muscles"),
            ("config", "a board's settings"),
            ("record", "a board's line into a file"),
            ("play", "a recording as CSV"),
            ("tables", "channels, settings and wire messages"),
        ],
    },
    Program {
        manifest: "ros2/Cargo.toml",
        features: &["--features", "bridge"],
        commands: &[("bridge", "fingertips into ROS 2")],
    },
    Program {
        manifest: "lab/Cargo.toml",
        features: &[],
        commands: &[
            ("check", "measure every promise; writes docs/results.md"),
            ("learn", "a camera teaches the Hebbian network"),
            ("dataset", "labelled recordings of the force array"),
            ("train", "intent recognition on recordings of people"),
            ("evaluate", "intent recognition, scored on people"),
            ("chart", "the figures of docs/"),
            ("vision", "skin and object in drawn pictures"),
        ],
    },
];

const IMAGE: [&str; 6] = ["--package", "tenax-firmware", "--bin", "tenax-firmware", "--profile", "firmware"];
const TARGET: &str = "thumbv7em-none-eabihf";

fn main() -> ExitCode {
    let mut arguments = std::env::args_os().skip(1);
    let command = arguments.next().unwrap_or_default();
    let rest: Vec<OsString> = arguments.collect();
    match start(command.to_str().unwrap_or_default(), &rest) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn start(command: &str, rest: &[OsString]) -> Result<ExitCode, String> {
    if matches!(command, "" | "help" | "--help" | "-h") {
        help();
        return Ok(ExitCode::SUCCESS);
    }
    match command {
        "test" => return test(rest),
        "page" => return page::page(rest),
        _ => {}
    }
    let has = |program: &&Program| program.commands.iter().any(|(name, _)| *name == command);
    let program = PROGRAMS
        .iter()
        .find(has)
        .ok_or_else(|| format!("there is no command `{command}`; `cargo tenax` lists them"))?;
    let mut run = cargo("run", program.manifest);
    run.arg("--release").args(program.features).arg("--");
    // The bridge's program is the command.
    if program.commands.len() > 1 {
        run.arg(command);
    }
    status(run.args(rest))
}

/// Every test, with the image that the emulated board runs.
fn test(rest: &[OsString]) -> Result<ExitCode, String> {
    let mut image = cargo("build", "Cargo.toml");
    image.args(IMAGE).args(["--target", TARGET]);
    let built = status(&mut image)?;
    if built != ExitCode::SUCCESS {
        return Ok(built);
    }
    let mut test = cargo("test", "Cargo.toml");
    // Tests of the line wait for real time to pass: twice as many at once take half as long.
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    test.env("RUST_TEST_THREADS", (2 * cores).to_string());
    status(
        test.args(["--release", "--no-fail-fast", "--workspace", "--exclude", "tenax-firmware"]).args(rest),
    )
}

/// In the person's folder, so that their paths hold. rigless asks for rustc 1.98 and builds on 1.95.
fn cargo(verb: &str, manifest: &str) -> Command {
    let mut cargo = Command::new("cargo");
    cargo.arg(verb).arg("--ignore-rust-version").arg("--manifest-path").arg(root().join(manifest));
    cargo
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."))
}

fn status(command: &mut Command) -> Result<ExitCode, String> {
    let status = command.status().map_err(|error| format!("cannot start {command:?}: {error}"))?;
    Ok(ExitCode::from(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(2)))
}

fn help() {
    println!("cargo tenax COMMAND [OPTIONS]; each command has --help\n");
    println!("  {:<12}run every test", "test");
    println!("  {:<12}the bench and a board in a browser, as a folder (--out FOLDER)", "page");
    for program in &PROGRAMS {
        println!();
        for (name, what) in program.commands {
            println!("  {name:<12}{what}");
        }
    }
}
