//! A progress bar on a terminal, silence elsewhere.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A run shorter than this shows no bar.
const SHOWN_AFTER: Duration = Duration::from_secs(2);

/// Virtual time going by.
pub struct Progress {
    bar: ProgressBar,
    begun: Instant,
}

impl Progress {
    /// A bar for so many virtual seconds, drawn to stderr once it is clear that it takes a while.
    pub fn new(what: &str, virtual_s: f64) -> Self {
        let bar = ProgressBar::with_draw_target(Some((virtual_s * 1e3) as u64), ProgressDrawTarget::hidden());
        let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %, {eta} left");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.set_message(what.to_owned());
        Self { bar, begun: Instant::now() }
    }

    /// So many virtual seconds have gone by.
    pub fn at(&mut self, virtual_s: f64) {
        if self.bar.is_hidden() && self.begun.elapsed() > SHOWN_AFTER {
            // indicatif itself draws nothing where stderr is no terminal.
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.set_position((virtual_s * 1e3) as u64);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
