//! `bars.toml`: the goals that are not reached yet, what is held instead, and why.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::LazyLock;

use serde::Deserialize;

/// A goal, and what is held as long as it is not reached.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Goal {
    /// What is measured, and its unit.
    pub what: String,
    /// What was asked.
    pub goal: f64,
    /// What a test fails at.
    pub held: f64,
    /// The day on which it was set.
    pub since: String,
    /// Why it is not the goal.
    pub why: String,
}

static ALL: LazyLock<BTreeMap<String, Goal>> = LazyLock::new(|| {
    toml::from_str(include_str!("../../bars.toml")).expect("bars.toml is checked by a test")
});

impl Goal {
    /// The one that is called so in `bars.toml`.
    ///
    /// # Panics
    /// If there is none: each name stands in the source, and a test or promise asks for it.
    pub fn of(name: &str) -> &'static Self {
        ALL.get(name).unwrap_or_else(|| panic!("bars.toml has no [{name}]"))
    }

    /// Whether a value is no worse than what is held. Whether more is better shows in which side of the goal that lies.
    pub fn holds(&self, value: f64) -> bool {
        if self.held > self.goal { value <= self.held } else { value >= self.held }
    }

    /// Whether a value reaches the goal itself.
    pub fn reached(&self, value: f64) -> bool {
        if self.held > self.goal { value <= self.goal } else { value >= self.goal }
    }
}

impl fmt::Display for Goal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, goal, held, since, why } = self;
        write!(f, "{what}: goal {goal}, held {held} since {since} ({why})")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bar_has_its_day_and_reason_and_is_short_of_its_goal() {
        assert!(!ALL.is_empty());
        for (name, bar) in &*ALL {
            assert!(bar.since.len() == 10 && bar.since.starts_with("20") && bar.why.len() > 20, "{name}");
            assert!(bar.held != bar.goal, "{name}: reached, so it belongs to the code that asks for it");
            assert!(bar.holds(bar.goal) && bar.holds(bar.held) && !bar.reached(bar.held), "{name}");
        }
    }

    #[test]
    fn a_bar_is_missed_beyond_what_is_held() {
        assert!(!Goal::of("learn-missed").holds(0.03) && Goal::of("learn-missed").reached(0.0));
        assert!(!Goal::of("learn-secured").holds(0.14) && Goal::of("learn-secured").reached(0.31));
    }
}
