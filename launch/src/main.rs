//! `cargo tenax`: see `cargo tenax --help`, which is the tool's.
#![forbid(unsafe_code)]

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result};
use tenax_launch::tool::{self, Tool};
use tenax_launch::{image, jobs};

fn main() -> ExitCode {
    launch().unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::from(2)
    })
}

fn launch() -> Result<ExitCode> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().context("the package is in the workspace")?;
    let arguments: Vec<_> = std::env::args_os().skip(1).collect();
    let tool = Tool::of(root, &arguments)?;
    let mut builds = vec![tool.job(root)];
    let binaries = tool::image_of(&arguments);
    if !binaries.is_empty() {
        builds.push(image::job(root, binaries));
    }
    jobs::run(builds)?;
    tool.become_it(root, &arguments)
}
