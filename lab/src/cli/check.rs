//! `tenax check`: every promise, measured, one line each.

use std::process::ExitCode;

use rayon::prelude::*;
use tenax_frames::tool::{out, progress::with_bar, workspace};
use tenax_sim::image;
use tenax_sim::jobs::Jobs;

use crate::check::{
    self, Bar, Group, Verdict, array, default_scene, drawn, learn, people, recordings, wearer,
};
use crate::learn::Options;

/// Measure every promise of the project, one line each; fails if one is not kept
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Run the host's build of the logic: no image, no emulator, fewer promises
    #[arg(long)]
    host: bool,
    /// Write docs/results.md
    #[arg(long, conflicts_with = "host")]
    write: bool,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let root = workspace::root()?;
    let data = root.join("../shared/data");
    let board = super::board(args.host)?;
    let image = if args.host { None } else { Some(image::build(&root)?) };
    let mut groups: Vec<Group> = vec![
        Box::new(|| default_scene::bars(&board, image.as_deref())),
        Box::new(wearer::scenes),
        Box::new(|| Ok(vec![wearer::random(&root)])),
    ];
    groups.extend(recordings::groups(&data, &board)?);
    groups.push(Box::new(|| people::bars(&data)));
    let options = Options { minutes: learn::MINUTES, ..Options::default() };
    groups.push(Box::new(move || learn::bars(&options, &|_, _| ())));
    groups.push(Box::new(drawn::bars));
    groups.push(Box::new(drawn::hour));
    groups.push(Box::new(array::bars));
    let bars: Vec<Vec<Bar>> = with_bar("check", |progress| {
        let jobs = Jobs::new(groups.len(), progress);
        let measure = |group: &Group| {
            let _job = jobs.begin();
            group()
        };
        groups.par_iter().map(measure).collect::<anyhow::Result<_>>()
    })?;
    let bars = bars.concat();
    if args.write {
        super::write(&root.join("docs/results.md"), check::page(&bars).as_bytes())?;
    }
    let [kept, failed, skipped] = [Verdict::Pass, Verdict::Fail, Verdict::Skipped]
        .map(|verdict| bars.iter().filter(|bar| bar.verdict == verdict).count());
    // Whoever stops reading still wants the verdict: it is the exit code.
    out::unless_closed(
        bars.iter()
            .try_for_each(|bar| out::say!("{bar}"))
            .and_then(|()| out::say!("{kept} kept, {failed} not kept, {skipped} skipped")),
    )?;
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
