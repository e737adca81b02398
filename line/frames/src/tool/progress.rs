//! Progress of a run on standard error.

use crate::tool::status::{SHOWN_AFTER, Status};

use super::out;

/// Progress in virtual time, or any other part of a whole. Dropped, it says how long it took, if that was more than 1 s.
pub struct Progress {
    what: String,
    virtual_s: f64,
    status: Status,
}

impl Progress {
    /// Of so many virtual seconds.
    pub fn new(what: &str, virtual_s: f64) -> Self {
        Self { what: what.to_owned(), virtual_s, status: Status::new(what) }
    }

    /// So many virtual seconds have gone by; infinitely many while the bound of a scene is searched.
    pub fn at(&self, virtual_s: f64) {
        let part = (virtual_s / self.virtual_s).clamp(0.0, 1.0);
        self.status.say_with(|elapsed| match virtual_s.is_infinite() {
            true => format!("{}: searching the least force that holds", self.what),
            false => {
                let left_s = elapsed.as_secs_f64() * (1.0 - part) / part.max(1e-6);
                format!("{} {:.0} %, {left_s:.0} s left", self.what, 100.0 * part)
            }
        });
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

/// Runs something that tells which part of it is done, 0 to 1.
pub fn with_bar<T>(what: &str, run: impl FnOnce(&(dyn Fn(f64) + Sync)) -> T) -> T {
    let progress = Progress::new(what, 1.0);
    run(&|part| progress.at(part))
}
