//! `tenax commands`: prints `docs/commands.md`. A test holds that file against this.

use std::fmt::Write;
use std::process::ExitCode;

use clap::{Arg, Command};

use super::out;

const HEAD: &str = "\
# Commands

Printed from the tool's own help by `cargo tenax commands`; do not edit. `--help` behind any of them says what its options mean and
gives examples.

| command | what it does | options |
|---|---|---|
";

/// Prints the page.
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
    let flag = |arg: &Arg| match arg.get_long() {
        Some(long) => Some(format!("`--{long}`")),
        None => arg.get_value_names().map(|names| format!("`{}`", names.join(" "))),
    };
    let shown = command.get_arguments().filter(|arg| !arg.is_hide_set() && !arg.is_global_set());
    let options: Vec<String> = shown.filter_map(flag).map(|flag| flag.replace('|', "/")).collect();
    // Writing into a String cannot fail.
    let _ = writeln!(page, "| `{name}` | {about} | {} |", options.join(", "));
    for own in command.get_subcommands() {
        row(page, &format!("{name} "), own);
    }
}
