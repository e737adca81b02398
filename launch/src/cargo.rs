//! A cargo command whose progress is read instead of shown.

use std::io::{BufReader, IsTerminal, Read, stderr};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};

use crate::jobs::Desk;

/// What Cargo says about its own work, and not about the code.
const STATES: [&str; 13] = [
    "Adding",
    "Blocking",
    "Building",
    "Checking",
    "Compiling",
    "Downloaded",
    "Downloading",
    "Fetch",
    "Finished",
    "Fresh",
    "Locking",
    "Running",
    "Updating",
];

/// Runs a cargo command to its end: its progress becomes the desk's state, everything else is told.
pub fn run(command: &mut Command, desk: &Desk) -> Result<()> {
    let program = command.get_program().to_owned();
    command
        // Cargo draws its bar for a terminal of this width, whatever standard error is.
        .env("CARGO_TERM_PROGRESS_WHEN", "always")
        .env("CARGO_TERM_PROGRESS_WIDTH", "120")
        .env("CARGO_TERM_QUIET", "false")
        .env("CARGO_TERM_COLOR", if stderr().is_terminal() { "always" } else { "never" })
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    let mut child = command.spawn().with_context(|| format!("cannot start {}", program.display()))?;
    let messages = child.stderr.take();
    *desk.child() = Some(child);
    if let Some(messages) = messages {
        listen(messages, desk)?;
    }
    let child = desk.child().take();
    let status = child.context("the process is gone")?.wait()?;
    ensure!(status.success(), "{} failed ({status}); its messages are above", program.display());
    Ok(())
}

fn listen(messages: impl Read, desk: &Desk) -> Result<()> {
    let mut line = Vec::new();
    for byte in BufReader::new(messages).bytes() {
        match byte? {
            b'\n' | b'\r' => hear(&String::from_utf8_lossy(&std::mem::take(&mut line)), desk),
            byte => line.push(byte),
        }
    }
    hear(&String::from_utf8_lossy(&line), desk);
    Ok(())
}

fn hear(line: &str, desk: &Desk) {
    let plain = without_colour(line);
    let plain = plain.trim();
    let word = plain.split(' ').next().unwrap_or("");
    if plain.is_empty() || word == "Compiling" || word == "Checking" {
        // The bar says it better.
    } else if STATES.contains(&word) {
        // `Building [===>  ] 104/209: rigless, usvg(build)`: all but the bar.
        let state = plain.split_once("] ").map_or(plain, |(_, state)| state);
        desk.state(state);
    } else {
        desk.tell(line.trim_end());
    }
}

/// The line without what a terminal takes for colours: ESC [ ... letter.
fn without_colour(line: &str) -> String {
    let mut parts = line.split("\x1b[");
    let mut plain = parts.next().unwrap_or("").to_owned();
    for part in parts {
        plain.push_str(part.split_once(|sign: char| sign.is_ascii_alphabetic()).map_or("", |(_, rest)| rest));
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heard(text: &str) -> (String, String) {
        let desk = Desk::default();
        listen(text.as_bytes(), &desk).unwrap();
        desk.heard()
    }

    #[test]
    fn the_bar_is_the_state_and_a_warning_is_told() {
        let text = "\x1b[1m\x1b[92m   Compiling\x1b[0m rigless v0.4.0\n\
            \x1b[K\x1b[1m\x1b[96m    Building\x1b[0m [=====>   ] 104/209: rigless, syn(build)\r\
            \x1b[K\x1b[33mwarning\x1b[0m: unused variable\n --> src/a.rs:1:1\n";
        let (state, said) = heard(text);
        assert_eq!(state, "104/209: rigless, syn(build)");
        assert_eq!(said, "\x1b[K\x1b[33mwarning\x1b[0m: unused variable\n --> src/a.rs:1:1\n");
    }

    #[test]
    fn waiting_is_a_state() {
        let (state, said) = heard("    Blocking waiting for file lock on build directory\n");
        assert_eq!(
            (state.as_str(), said.as_str()),
            ("Blocking waiting for file lock on build directory", "")
        );
    }
}
