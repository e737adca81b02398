//! How far a run is, on standard error, for as long as it takes.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use crate::tool::status::{SHOWN_AFTER, Status};

use super::out;

/// Saying it more often would only cost time.
const SAID_EVERY: Duration = Duration::from_millis(100);

/// Virtual time going by, or any other part of a whole. When it is dropped, it says how long it took, if it was long.
pub struct Progress {
    what: String,
    virtual_s: f64,
    said: Mutex<Instant>,
    status: Status,
}

impl Progress {
    /// So many virtual seconds are to go by.
    pub fn new(what: &str, virtual_s: f64) -> Self {
        Self { what: what.to_owned(), virtual_s, said: Mutex::new(Instant::now()), status: Status::new(what) }
    }

    /// So many virtual seconds have gone by; infinitely many while the bound of a scene is searched.
    pub fn at(&self, virtual_s: f64) {
        if virtual_s.is_infinite() {
            return self.status.say(format!("{}: searching the least force that holds", self.what));
        }
        let part = (virtual_s / self.virtual_s).clamp(0.0, 1.0);
        // Whoever finds another thread saying it has nothing to add.
        let Ok(mut said) = self.said.try_lock() else {
            return;
        };
        if part > 0.0 && said.elapsed() >= SAID_EVERY {
            *said = Instant::now();
            let left_s = self.status.elapsed().as_secs_f64() * (1.0 - part) / part;
            self.status.say(format!("{} {:.0} %, {left_s:.0} s left", self.what, 100.0 * part));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        let elapsed = self.status.elapsed();
        if elapsed >= SHOWN_AFTER {
            self.status.print(|| out::note!("  {} took {:.0} s", self.what, elapsed.as_secs_f64()));
        }
    }
}

/// Does something that says how much of it is done, from 0 to 1.
pub fn with_bar<T>(what: &str, run: impl FnOnce(&(dyn Fn(f64) + Sync)) -> T) -> T {
    let progress = Progress::new(what, 1.0);
    run(&|part| progress.at(part))
}
