//! The tool as a person starts it, to its end.

use std::process::{Command, Output};

use ratatui::Terminal;
use ratatui::backend::TestBackend;
use tenax_serial::monitor::screen::{Shown, draw};
use tenax_serial::monitor::view::View;

/// Runs a command: whether it succeeded, what it printed, and what it said beside that.
pub fn tenax(args: &[&str]) -> (bool, String, String) {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_tenax-host")).args(args).output().unwrap();
    let [out, error] = [stdout, stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    (status.success(), out, error)
}

/// The monitor's screen, line by line.
pub fn picture(view: &View, shown: &Shown, width: u16, height: u16) -> String {
    let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
    terminal.draw(|frame| draw(frame, view, shown)).unwrap();
    let buffer = terminal.backend().buffer();
    let line = |y| (0..width).map(|x| buffer[(x, y)].symbol()).collect::<String>();
    (0..height).map(|y| line(y) + "\n").collect()
}
