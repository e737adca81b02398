//! Every promise of docs/results.md as a bar: what is promised, what was measured, whether it holds.

pub mod agreement;
pub mod array;
pub mod default_scene;
pub mod learn;
pub mod mistakes;
pub mod recordings;
pub mod side_by_side;
pub mod wearer;

use std::fmt::{self, Display};


/// Whether a promise holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Pass,
    Fail,
    /// It could not be measured here.
    Skipped,
    /// It says as much about the machine and its load as about the project, so nothing is kept or broken by it.
    Noted,
}

/// A goal that is not reached yet, and what is held until then.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// Quantity and unit.
    pub what: &'static str,
    pub goal: f64,
    /// `check` fails beyond it.
    pub held: f64,
}

impl Goal {
    /// More is better where the goal is above what is held.
    fn is_met(self, value: f64, bar: f64) -> bool {
        if self.held > self.goal { value <= bar } else { value >= bar }
    }
}

/// One promise, measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bar {
    pub promise: String,
    /// What was measured.
    pub figure: String,
    pub verdict: Verdict,
}

impl Bar {
    /// A promise that was measured.
    pub fn new(promise: impl Into<String>, figure: impl Into<String>, holds: bool) -> Self {
        Self {
            promise: promise.into(),
            figure: figure.into(),
            verdict: if holds { Verdict::Pass } else { Verdict::Fail },
        }
    }

    /// What is held of a goal that is not reached yet, its value and what it was measured by.
    pub fn short_of(goal: Goal, value: f64, figure: impl Display) -> Self {
        let reached = if goal.is_met(value, goal.goal) { "the goal is reached" } else { "short of the goal" };
        Self::new(
            format!("{}: held {}, goal {}", goal.what, goal.held, goal.goal),
            format!("{value:.3}, {reached}; {figure}"),
            goal.is_met(value, goal.held),
        )
    }

    /// A figure that is told and not judged, such as a wall clock's.
    pub fn noted(what: impl Into<String>, figure: impl Into<String>) -> Self {
        Self { promise: what.into(), figure: figure.into(), verdict: Verdict::Noted }
    }

    /// A promise that cannot be measured here.
    pub fn skipped(promise: impl Into<String>, why: impl Into<String>) -> Self {
        Self { promise: promise.into(), figure: why.into(), verdict: Verdict::Skipped }
    }
}

impl Display for Bar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = match self.verdict {
            Verdict::Pass => "PASS",
            Verdict::Fail => "FAIL",
            Verdict::Skipped => "skipped",
            Verdict::Noted => "noted",
        };
        write!(f, "{verdict:<8}{}: {}", self.promise, self.figure)
    }
}
