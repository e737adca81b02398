//! Jobs side by side, with one line that says how far each is.

use std::process::Child;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use anyhow::Result;

use crate::status::{SHOWN_AFTER, Status};

const LOOKED_AT_EVERY: Duration = Duration::from_millis(200);
/// Characters of one job's state while another runs too.
const STATE_BESIDE_OTHERS: usize = 28;

/// Something that takes a while.
pub struct Job<'a> {
    /// What it makes.
    pub name: &'static str,
    /// What has happened to it when it has succeeded: `built`.
    pub done: &'static str,
    /// Makes it.
    pub run: Work<'a>,
}

/// What a job does, told where to say how far it is.
pub type Work<'a> = Box<dyn FnOnce(&Desk) -> Result<()> + Send + 'a>;

/// Where a job says how far it is.
#[derive(Default)]
pub struct Desk {
    state: Mutex<String>,
    said: Mutex<String>,
    child: Mutex<Option<Child>>,
}

impl Desk {
    /// How far it is, in a few words.
    pub fn state(&self, state: impl Into<String>) {
        *lock(&self.state) = state.into();
    }

    /// A line for the person, shown when the job has ended.
    pub fn tell(&self, line: &str) {
        let mut said = lock(&self.said);
        said.push_str(line);
        said.push('\n');
    }

    #[cfg(test)]
    pub(crate) fn heard(self) -> (String, String) {
        (lock(&self.state).clone(), lock(&self.said).clone())
    }

    /// The process that does it, to be ended if another job fails.
    pub(crate) fn child(&self) -> std::sync::MutexGuard<'_, Option<Child>> {
        lock(&self.child)
    }
}

/// Runs the jobs to their end; at the first that fails, ends the others. Fails with the first job's that failed.
pub fn run(jobs: Vec<Job<'_>>) -> Result<()> {
    let names: Vec<&str> = jobs.iter().map(|job| job.name).collect();
    let done: Vec<&str> = jobs.iter().map(|job| job.done).collect();
    let desks: Vec<Desk> = jobs.iter().map(|_| Desk::default()).collect();
    let mut running = vec![true; jobs.len()];
    let status = Status::new(&names.join(", "));
    let begun = Instant::now();
    let (ended, ends) = mpsc::channel();
    std::thread::scope(|scope| {
        for (n, (job, desk)) in jobs.into_iter().zip(&desks).enumerate() {
            let ended = ended.clone();
            scope.spawn(move || ended.send((n, (job.run)(desk))));
        }
        drop(ended);
        let mut first_error = None;
        loop {
            match ends.recv_timeout(LOOKED_AT_EVERY) {
                Ok((n, result)) => {
                    running[n] = false;
                    // What was ended because another job failed is no news.
                    if first_error.is_none() {
                        status.print(|| eprint!("{}", lock(&desks[n].said)));
                        match result {
                            Ok(()) => tell_time(&status, names[n], done[n], begun),
                            Err(error) => {
                                first_error = Some(error);
                                end_all(&desks);
                            }
                        }
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break,
            }
            let left = running.iter().filter(|running| **running).count();
            let states = (0..names.len()).filter(|&n| running[n]).map(|n| {
                // So that the others are seen too.
                let most = if left > 1 { STATE_BESIDE_OTHERS } else { usize::MAX };
                let state: String = lock(&desks[n].state).chars().take(most).collect();
                format!("{} {state}", names[n])
            });
            status.say(states.collect::<Vec<_>>().join(" | "));
        }
        first_error.map_or(Ok(()), Err)
    })
}

fn tell_time(status: &Status, name: &str, done: &str, begun: Instant) {
    if begun.elapsed() >= SHOWN_AFTER {
        status.print(|| eprintln!("  {name} {done} in {:.0} s", begun.elapsed().as_secs_f64()));
    }
}

fn end_all(desks: &[Desk]) {
    for desk in desks {
        if let Some(child) = desk.child().as_mut() {
            // It may have ended by itself in the meantime.
            let _ = child.kill();
        }
    }
}

fn lock<T>(shared: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
