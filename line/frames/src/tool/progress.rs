//! Progress on one line of standard error: redrawn on a terminal, repeated every few seconds in a log.

use std::io::{IsTerminal, Write, stderr};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use super::out;

const SHOWN_AFTER: Duration = Duration::from_secs(1);
/// Intervals in a log and on a terminal.
const REPEATED_AFTER: Duration = Duration::from_secs(4);
const REDRAWN_AFTER: Duration = Duration::from_millis(500);
/// A terminal's line, in characters, less one: the last column would wrap.
const COLUMNS: usize = 79;

/// Progress in virtual time, or any other part of a whole. Dropped, it says how long it took, if that was more than 1 s.
pub struct Progress {
    what: String,
    whole_s: f64,
    begun: Instant,
    is_terminal: bool,
    shown: Mutex<Option<Instant>>,
}

impl Progress {
    pub fn new(what: &str, whole_s: f64) -> Self {
        let is_terminal =
            stderr().is_terminal() && std::env::var_os("TERM").is_none_or(|term| term != "dumb");
        Self { what: what.to_owned(), whole_s, begun: Instant::now(), is_terminal, shown: Mutex::new(None) }
    }

    /// So many virtual seconds have gone by; infinitely many while the bound of a scene is searched.
    pub fn at(&self, virtual_s: f64) {
        let part = (virtual_s / self.whole_s).clamp(0.0, 1.0);
        self.say(|elapsed| match virtual_s.is_infinite() {
            true => format!("{}: searching the least force that holds", self.what),
            false => {
                let left_s = elapsed.as_secs_f64() * (1.0 - part) / part;
                let left = if part < 0.02 { String::new() } else { format!(", {left_s:.0} s left") };
                format!("{} {:.0} %{left}", self.what, 100.0 * part)
            }
        });
    }

    /// Shows a text, made from the time since the begin, if it is time to.
    pub fn say(&self, text: impl FnOnce(Duration) -> String) {
        let elapsed = self.begun.elapsed();
        let every = if self.is_terminal { REDRAWN_AFTER } else { REPEATED_AFTER };
        // Another thread that has the lock shows its text.
        let Ok(mut shown) = self.shown.try_lock() else { return };
        if elapsed < SHOWN_AFTER || shown.is_some_and(|shown| shown.elapsed() < every) {
            return;
        }
        let text = format!("{:>5} s  {}", elapsed.as_secs(), text(elapsed));
        let text: String = text.chars().take(COLUMNS).collect();
        let text = if self.is_terminal { format!("\r{text}\x1b[K") } else { format!("{text}\n") };
        // In one piece: others write there too.
        let _ = stderr().write_all(text.as_bytes());
        *shown = Some(Instant::now());
    }

    pub fn clear(&self) {
        if self.is_terminal {
            let _ = write!(stderr(), "\r\x1b[K");
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.clear();
        let elapsed = self.begun.elapsed();
        if elapsed >= SHOWN_AFTER {
            out::note!("  {} took {:.0} s", self.what, elapsed.as_secs_f64());
        }
    }
}

/// Runs something that tells which part of it is done, 0 to 1.
pub fn with_bar<T>(what: &str, run: impl FnOnce(&(dyn Fn(f64) + Sync)) -> T) -> T {
    let progress = Progress::new(what, 1.0);
    run(&|part| progress.at(part))
}
