//! `tenax hand`: several fingertips and a palm on one object.

use std::process::ExitCode;

use tenax_bench::hand::report::{self, Report};
use tenax_bench::session::load_scene;
use tenax_scene::SceneFile;

use super::format::Format;
use super::out;
use super::progress::Progress;

/// Run a hand of several fingertips, with a palm and without, on the host.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  tenax hand                            four scenes, five seeds each, and 40 runs with a failing part
  tenax hand --scene ice --seeds 40     one scene
  tenax hand --seeds 1 --cuts 1000      1000 runs in which a finger, the palm or the bus fails
  tenax hand --report json > hand.json  for programs
  tenax hand --emulated                 two fingertips' images and the palm's on one bus
  tenax hand --emulated --scene ice --until 6   six images, 6 s")]
pub struct Args {
    /// Scenes of scenes/hand/, or files like them [default: all of them]
    #[arg(long, value_name = "NAME|FILE.toml")]
    scene: Vec<String>,
    /// Runs of each scene, with seeds from 101 on (the constants were chosen on others)
    #[arg(long, default_value_t = 5)]
    seeds: u64,
    /// Number of runs in which a finger, the palm or the bus fails at a random instant
    #[arg(long, default_value_t = 40)]
    cuts: u64,
    /// Run each scene once with an emulated board for each fingertip and for the palm, and compare with the host's build byte for byte [default
    /// scene: pinch]
    #[arg(long, conflicts_with_all = ["seeds", "cuts"])]
    emulated: bool,
    /// Stop at this time of the scene, s
    #[arg(long, value_name = "SECONDS", requires = "emulated")]
    until: Option<f64>,
    /// How to print the report
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let all = || tenax_scene::builtin::hands().iter().map(|(name, _)| (*name).to_owned()).collect();
    let names: Vec<String> = if args.scene.is_empty() && args.emulated {
        vec!["pinch".to_owned()]
    } else if args.scene.is_empty() {
        all()
    } else {
        args.scene.clone()
    };
    let files = names.iter().map(|name| load_scene(name)).collect::<anyhow::Result<Vec<_>>>()?;
    if let Some(file) = files.iter().find(|file| file.finger_count() < 2) {
        anyhow::bail!("{} has no [fingers]: it is a scene of one fingertip, for `tenax run`", file.name);
    }
    if args.emulated {
        return emulated(args, &files);
    }
    let progress = Progress::new("hand", files.len() as f64);
    let mut scenes = Vec::new();
    for file in &files {
        scenes.push(report::scene(file, 101..101 + args.seeds));
        progress.at(scenes.len() as f64);
    }
    let cuts = (args.cuts > 0).then(|| report::cuts(&files, args.cuts));
    let report = Report { scenes, cuts };
    args.report.print(&report, &report)?;
    if !report.holds() {
        out::note!("something that must never happen did");
    }
    Ok(ExitCode::from(u8::from(!report.holds())))
}

/// The images, and whether they do as the host's build does.
#[cfg(feature = "emulator")]
fn emulated(args: &Args, files: &[SceneFile]) -> anyhow::Result<ExitCode> {
    use super::workspace;
    use tenax_bench::hand::emulated::{Options, run};

    let root = workspace::root()?;
    let (image, palm) = (tenax_bench::image::build(&root)?, tenax_bench::image::build_palm(&root)?);
    let options = Options { until_s: args.until.unwrap_or(f64::INFINITY), ..Options::default() };
    let mut holds = true;
    for file in files {
        let outcome = run([&image, &palm], file, &options)?;
        holds &= outcome.holds();
        args.report.print(&outcome, &outcome)?;
    }
    if !holds {
        out::note!("an image differs from the host's build, lost something, or was late");
    }
    Ok(ExitCode::from(u8::from(!holds)))
}

#[cfg(not(feature = "emulator"))]
fn emulated(_args: &Args, _files: &[SceneFile]) -> anyhow::Result<ExitCode> {
    anyhow::bail!("this tool was built without the emulated board: use `cargo tenax`")
}
