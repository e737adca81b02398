//! `tenax commands`: prints `docs/commands.md`. A test holds that file against this.

use std::fmt::Write;
use std::process::ExitCode;

use clap::Command;

use super::out;

const HEAD: &str = "\
# Commands

This page lists what `cargo tenax` can do. `--help` behind a command gives its options and examples. Printed by `cargo tenax commands`; do not edit.

| command | what it does |
|---|---|
";

pub fn main(cli: &Command) -> anyhow::Result<ExitCode> {
    out::print(format_args!("{}", markdown(cli)))?;
    Ok(ExitCode::SUCCESS)
}

fn markdown(cli: &Command) -> String {
    let mut page = String::from(HEAD);
    for command in cli.get_subcommands().filter(|command| !command.is_hide_set()) {
        row(&mut page, "", command);
    }
    page
}

/// A command's row, and those of its own commands.
fn row(page: &mut String, before: &str, command: &Command) {
    let name = format!("{before}{}", command.get_name());
    let about = command.get_about().map(ToString::to_string).unwrap_or_default().replace('|', "or");
    // Writing into a String cannot fail.
    let _ = writeln!(page, "| `{name}` | {about} |");
    for own in command.get_subcommands() {
        row(page, &format!("{name} "), own);
    }
}
