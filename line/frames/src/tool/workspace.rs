//! Where the sources are, for the commands that build or test them.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail};

/// The workspace: the nearest folder upwards that holds this project, else where the tool was built from.
pub fn root() -> anyhow::Result<PathBuf> {
    let here = std::env::current_dir().context("the current folder is gone")?;
    let built_from = Path::new(env!("CARGO_MANIFEST_DIR")).parent();
    let mut candidates = here.ancestors().chain(built_from);
    match candidates.find(|folder| folder.join("memory.x").exists() && folder.join("hal-shim").exists()) {
        Some(folder) => Ok(folder.to_owned()),
        None => bail!("this needs the project's sources: run it inside a checkout"),
    }
}

/// Runs a command to its end in the workspace; whether it succeeded.
pub fn run(command: &mut Command) -> anyhow::Result<bool> {
    let shown = format!("{command:?}").replace('"', "");
    eprintln!("$ {shown}");
    let status = command.current_dir(root()?).status().with_context(|| format!("cannot start {shown}"))?;
    Ok(status.success())
}
