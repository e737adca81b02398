//! The tool as a person starts it, to its end.

use std::process::{Command, Output};

pub use crate::picture::picture;

/// Runs a command: whether it succeeded, what it printed, and what it said beside that.
pub fn tenax(args: &[&str]) -> (bool, String, String) {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_tenax-host")).args(args).output().unwrap();
    let [out, error] = [stdout, stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    (status.success(), out, error)
}
