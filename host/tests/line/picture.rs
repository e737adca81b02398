//! What a person sees of the monitor.

use ratatui::Terminal;
use ratatui::backend::TestBackend;
use tenax_serial::monitor::screen::{Shown, draw};
use tenax_serial::monitor::view::View;

/// The monitor's screen, line by line.
pub fn picture(view: &View, shown: &Shown, width: u16, height: u16) -> String {
    let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
    terminal.draw(|frame| draw(frame, view, shown)).unwrap();
    let buffer = terminal.backend().buffer();
    let line = |y| (0..width).map(|x| buffer[(x, y)].symbol()).collect::<String>();
    (0..height).map(|y| line(y) + "\n").collect()
}
