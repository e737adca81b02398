//! One line on standard error that says what is being done: redrawn on a terminal, repeated every few seconds in a log.

use std::io::{IsTerminal, Write, stderr};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// What takes no longer than this is not worth a line.
pub const SHOWN_AFTER: Duration = Duration::from_secs(1);
/// In a log, a line so often.
const REPEATED_AFTER: Duration = Duration::from_secs(4);
const REDRAWN_AFTER: Duration = Duration::from_millis(500);
const LOOKED_AT_EVERY: Duration = Duration::from_millis(100);
/// A terminal's line, in characters, less one: the last column would wrap.
const COLUMNS: usize = 79;

/// The line. It is gone when this is dropped.
pub struct Status {
    shared: Arc<Mutex<Line>>,
    ticker: Option<JoinHandle<()>>,
}

struct Line {
    text: String,
    begun: Instant,
    /// When it was last on the screen or in the log.
    shown: Option<Instant>,
    terminal: bool,
    /// Whether the terminal shows it now.
    drawn: bool,
    over: bool,
}

impl Status {
    /// Nothing is shown before [`SHOWN_AFTER`].
    pub fn new(text: &str) -> Self {
        let terminal = stderr().is_terminal() && std::env::var_os("TERM").is_none_or(|term| term != "dumb");
        let line = Line {
            text: text.to_owned(),
            begun: Instant::now(),
            shown: None,
            terminal,
            drawn: false,
            over: false,
        };
        let shared = Arc::new(Mutex::new(line));
        let ticked = Arc::clone(&shared);
        let ticker = std::thread::spawn(move || {
            while !lock(&ticked).tick() {
                std::thread::park_timeout(LOOKED_AT_EVERY);
            }
        });
        Self { shared, ticker: Some(ticker) }
    }

    /// Says something else from now on.
    pub fn say(&self, text: String) {
        lock(&self.shared).text = text;
    }

    /// Prints what is to stay, on any stream, without a trace of the line in between.
    pub fn print(&self, print: impl FnOnce()) {
        let mut line = lock(&self.shared);
        line.clear();
        print();
        // A printed line is a sign of life too.
        line.shown = Some(Instant::now());
    }

    /// For how long it has been shown or could have been.
    pub fn elapsed(&self) -> Duration {
        lock(&self.shared).begun.elapsed()
    }
}

impl Drop for Status {
    fn drop(&mut self) {
        {
            let mut line = lock(&self.shared);
            line.over = true;
            line.clear();
        }
        if let Some(ticker) = self.ticker.take() {
            ticker.thread().unpark();
            // A ticker that panicked has nothing left to clean up.
            let _ = ticker.join();
        }
    }
}

impl Line {
    /// Shows the line if it is time; whether it is over.
    fn tick(&mut self) -> bool {
        let every = if self.terminal { REDRAWN_AFTER } else { REPEATED_AFTER };
        let due = match self.shown {
            Some(shown) => shown.elapsed() >= every,
            None => self.begun.elapsed() >= SHOWN_AFTER,
        };
        if due && !self.over {
            let text = format!("{:>5} s  {}", self.begun.elapsed().as_secs(), self.text);
            let text: String = text.chars().take(COLUMNS).collect();
            let text = if self.terminal { format!("\r{text}\x1b[K") } else { format!("{text}\n") };
            // In one piece: others write there too. Nobody can be told that standard error is gone.
            let _ = stderr().write_all(text.as_bytes());
            let _ = stderr().flush();
            self.drawn = self.terminal;
            self.shown = Some(Instant::now());
        }
        self.over
    }

    fn clear(&mut self) {
        if std::mem::take(&mut self.drawn) {
            let _ = write!(stderr(), "\r\x1b[K");
        }
    }
}

/// A line that a panicking thread left is still a line.
fn lock(line: &Mutex<Line>) -> MutexGuard<'_, Line> {
    line.lock().unwrap_or_else(PoisonError::into_inner)
}
