//! One line on standard error: redrawn on a terminal, repeated every few seconds in a log.

use std::io::{IsTerminal, Write, stderr};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// What takes less is not shown.
pub const SHOWN_AFTER: Duration = Duration::from_secs(1);
/// Intervals in a log and on a terminal.
const REPEATED_AFTER: Duration = Duration::from_secs(4);
const REDRAWN_AFTER: Duration = Duration::from_millis(500);
/// A terminal's line, in characters, less one: the last column would wrap.
const COLUMNS: usize = 79;

/// The line. It is cleared when this is dropped.
pub struct Status {
    begun: Instant,
    terminal: bool,
    /// When it was shown last.
    shown: Mutex<Option<Instant>>,
}

impl Status {
    pub fn new(text: &str) -> Self {
        let terminal = stderr().is_terminal() && std::env::var_os("TERM").is_none_or(|term| term != "dumb");
        let status = Self { begun: Instant::now(), terminal, shown: Mutex::new(None) };
        status.say(text.to_owned());
        status
    }

    /// Shows this text, if it is time to.
    pub fn say(&self, text: String) {
        self.say_with(|_| text);
    }

    /// The same with a text that is made only then, from the time since the begin.
    pub fn say_with(&self, text: impl FnOnce(Duration) -> String) {
        let elapsed = self.elapsed();
        let every = if self.terminal { REDRAWN_AFTER } else { REPEATED_AFTER };
        // Another thread that has the lock shows its text.
        let Ok(mut shown) = self.shown.try_lock() else { return };
        if elapsed < SHOWN_AFTER || shown.is_some_and(|shown| shown.elapsed() < every) {
            return;
        }
        let text = format!("{:>5} s  {}", elapsed.as_secs(), text(elapsed));
        let text: String = text.chars().take(COLUMNS).collect();
        let text = if self.terminal { format!("\r{text}\x1b[K") } else { format!("{text}\n") };
        // In one piece: others write there too.
        let _ = stderr().write_all(text.as_bytes());
        *shown = Some(Instant::now());
    }

    /// Clears the line and prints something that stays, on any stream.
    pub fn print(&self, print: impl FnOnce()) {
        self.clear();
        print();
    }

    pub fn elapsed(&self) -> Duration {
        self.begun.elapsed()
    }

    fn clear(&self) {
        if self.terminal {
            let _ = write!(stderr(), "\r\x1b[K");
        }
    }
}

impl Drop for Status {
    fn drop(&mut self) {
        self.clear();
    }
}
