//! Every promise of docs/results.md as a bar: promise, measured value, limit, verdict.

pub mod array;
pub mod default_scene;
pub mod drawn;
pub mod learn;
pub mod people;
pub mod recordings;
pub mod wearer;

use std::fmt::{self, Display};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Pass,
    Fail,
    /// Not measurable here.
    Skipped,
    /// Measured without a limit.
    Noted,
    /// A wall clock's figure, which depends on the machine: printed, not written to docs/results.md.
    Clock,
}

impl Verdict {
    const fn name(self) -> &'static str {
        match self {
            Self::Pass => "kept",
            Self::Fail => "NOT KEPT",
            Self::Skipped => "skipped",
            Self::Noted | Self::Clock => "noted",
        }
    }
}

/// A goal that is not reached yet, and the limit until then, in one unit.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// Quantity and unit.
    pub what: &'static str,
    pub goal: f64,
    /// `check` fails beyond it.
    pub held: f64,
}

/// One promise, measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bar {
    pub promise: String,
    pub measured: String,
    /// Empty where there is none.
    pub limit: String,
    pub verdict: Verdict,
}

impl Bar {
    pub fn new(
        promise: impl Into<String>,
        measured: impl Into<String>,
        limit: impl Into<String>,
        holds: bool,
    ) -> Self {
        let verdict = if holds { Verdict::Pass } else { Verdict::Fail };
        Self { promise: promise.into(), measured: measured.into(), limit: limit.into(), verdict }
    }

    /// The limit of a goal that is not reached yet, the value, and what it was measured by. More is better where the goal is above
    /// the limit.
    pub fn short_of(Goal { what, goal, held }: Goal, value: f64, by: impl Display) -> Self {
        let holds = if held > goal { value <= held } else { value >= held };
        let measured = format!("{value:.3}; {by}");
        Self::new(what, measured.trim_end_matches("; "), format!("{held}, goal {goal}"), holds)
    }

    pub fn unjudged(promise: impl Into<String>, measured: impl Into<String>, verdict: Verdict) -> Self {
        Self { verdict, ..Self::new(promise, measured, "", true) }
    }
}

impl Display for Bar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<10}{}: {}", self.verdict.name(), self.promise, self.measured)?;
        if self.limit.is_empty() { Ok(()) } else { write!(f, "; limit {}", self.limit) }
    }
}

/// Bars that are measured together, beside other groups.
pub type Group<'a> = Box<dyn Fn() -> anyhow::Result<Vec<Bar>> + Sync + Send + 'a>;

/// The promise without its recording's name, if it is about one.
fn of_recordings(bar: &Bar) -> Option<&str> {
    bar.promise.split_once(".csv: ").map(|(_, promise)| promise)
}

/// docs/results.md: the same bytes for the same commit.
pub fn page(bars: &[Bar]) -> String {
    let mut text = String::from(
        "# Results\n\nWritten by `cargo tenax check --write`: each promise, measured, with seed 1 (the array's data: 4). No real board was measured.\n\n",
    );
    let judged: Vec<&Bar> = bars.iter().filter(|bar| bar.verdict != Verdict::Clock).collect();
    // One line for recordings of one promise and verdict: the program prints each.
    for rows in judged.chunk_by(|a, b| {
        a.verdict == b.verdict && of_recordings(a).is_some_and(|own| of_recordings(b) == Some(own))
    }) {
        let Some((first, others)) = rows.split_first() else { continue };
        let (promise, of) = match of_recordings(first) {
            Some(promise) if !others.is_empty() => {
                (promise, format!("{} recordings, the first: ", rows.len()))
            }
            _ => (first.promise.as_str(), String::new()),
        };
        let limit = if first.limit.is_empty() { String::new() } else { format!("; limit {}", first.limit) };
        text += &format!("- {}: {promise}: {of}{}{limit}\n", first.verdict.name(), first.measured);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_an_upper_one_where_the_goal_is_below_it() {
        let of = |goal, held, value| Bar::short_of(Goal { what: "x", goal, held }, value, "y").verdict;
        assert_eq!([0.5, 1.0, 1.5].map(|x| of(0.0, 1.0, x)), [Verdict::Pass, Verdict::Pass, Verdict::Fail]);
        assert_eq!([0.5, 0.7, 1.0].map(|x| of(0.95, 0.7, x)), [Verdict::Fail, Verdict::Pass, Verdict::Pass]);
    }

    #[test]
    fn the_page_has_every_line_but_those_of_the_clock() {
        let bars = [
            Bar::new("a | b", "1 mm", "2 mm", true),
            Bar::unjudged("speed", "3 s", Verdict::Clock),
            Bar::new("c", "4", "3", false),
        ];
        let page = page(&bars);
        assert!(page.ends_with("\n\n- kept: a | b: 1 mm; limit 2 mm\n- NOT KEPT: c: 4; limit 3\n"), "{page}");
    }
}
