//! A progress bar on a terminal, silence elsewhere.

use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::JoinHandle;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A run shorter than this shows no bar.
const SHOWN_AFTER: Duration = Duration::from_secs(2);
/// The bar moves this often, even while nobody says how far it is.
const TICK: Duration = Duration::from_millis(200);

/// Work going by: virtual time, or a part of the whole.
pub struct Progress {
    bar: ProgressBar,
    /// Dropped when the work is over.
    over: Option<Sender<()>>,
    shows: Option<JoinHandle<()>>,
}

impl Progress {
    /// A bar for so many virtual seconds, drawn to stderr once it is clear that it takes a while.
    pub fn new(what: &str, virtual_s: f64) -> Self {
        let bar = ProgressBar::with_draw_target(Some((virtual_s * 1e3) as u64), ProgressDrawTarget::hidden());
        let style =
            ProgressStyle::with_template("{spinner} {msg} {wide_bar} {percent:>3} %, {elapsed}, {eta} left");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.set_message(what.to_owned());
        let (over, work) = mpsc::channel();
        let shown = bar.clone();
        let shows = std::thread::spawn(move || {
            if work.recv_timeout(SHOWN_AFTER) == Err(RecvTimeoutError::Timeout) {
                // indicatif itself draws nothing where stderr is no terminal.
                shown.set_draw_target(ProgressDrawTarget::stderr());
                shown.enable_steady_tick(TICK);
            }
        });
        Self { bar, over: Some(over), shows: Some(shows) }
    }

    /// So many virtual seconds have gone by.
    pub fn at(&mut self, virtual_s: f64) {
        self.bar.set_position((virtual_s * 1e3) as u64);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        drop(self.over.take());
        // It has nothing to panic about, and a bar is no reason to.
        let _ = self.shows.take().map(JoinHandle::join);
        self.bar.finish_and_clear();
    }
}

/// Does something with a bar that it tells how much is done, from 0 to 1.
pub fn with_bar<T>(what: &str, run: impl FnOnce(&(dyn Fn(f64) + Sync)) -> T) -> T {
    let progress = Progress::new(what, 1.0);
    run(&|part| progress.bar.set_position((part * 1e3) as u64))
}
