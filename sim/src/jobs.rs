//! How much is done of jobs that run side by side.

use std::sync::{Mutex, PoisonError};

/// Told how much is done, from 0 to 1.
pub type Told<'a> = &'a (dyn Fn(f64) + Sync);

pub struct Jobs<'a> {
    count: usize,
    done: Mutex<f64>,
    told: Told<'a>,
}

impl<'a> Jobs<'a> {
    pub const fn new(count: usize, told: Told<'a>) -> Self {
        Self { count, done: Mutex::new(0.0), told }
    }

    pub const fn begin(&self) -> Job<'_> {
        Job { jobs: self, part: 0.0 }
    }
}

pub struct Job<'a> {
    jobs: &'a Jobs<'a>,
    part: f64,
}

impl Job<'_> {
    /// So much of it is done, 0 to 1.
    pub fn at(&mut self, part: f64) {
        let more = part.clamp(self.part, 1.0) - self.part;
        self.part += more;
        // A sum that a panicking thread left is still a sum.
        let mut done = self.jobs.done.lock().unwrap_or_else(PoisonError::into_inner);
        *done += more;
        (self.jobs.told)((*done / self.jobs.count.max(1) as f64).min(1.0));
    }
}

impl Drop for Job<'_> {
    fn drop(&mut self) {
        self.at(1.0);
    }
}
