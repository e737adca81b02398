//! `budgets.toml`: what the image may take of the chip.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use serde::Deserialize;

/// The budgets, in the file's words and units.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Budgets {
    /// Code, constants and first values.
    pub flash_bytes: u64,
    /// Variables.
    pub ram_bytes: u64,
    /// The stack at its worst.
    pub stack_bytes: u64,
    pub tick_instructions_mean: u64,
    pub tick_instructions_max: u64,
    /// Everything that the core executes in a period of 0.5 ms, mean.
    pub period_instructions_mean: u64,
    /// The array's sliding covariance, a slow frame.
    pub array_covariance_instructions: u64,
    pub array_spectrum_instructions: u64,
    pub array_network_instructions: u64,
    /// All that the array costs in a slow frame.
    pub array_slow_frame_instructions: u64,
    /// Places from which the image may panic, by the crate whose source they are in.
    pub panic_sites: BTreeMap<String, u64>,
}

impl Budgets {
    /// Those of this checkout. An error says what is wrong with the file, and where.
    pub fn of_checkout() -> Result<Self> {
        toml::from_str(include_str!("../../budgets.toml")).context("budgets.toml")
    }
}

/// One line of the table: what was measured, beside what is allowed.
#[derive(Clone, Debug)]
pub struct Line {
    pub what: &'static str,
    pub unit: &'static str,
    /// What was measured, None where it could not be.
    pub measured: Option<u64>,
    pub budget: u64,
    /// All that the chip has, where that is a number.
    pub of: Option<u64>,
}

impl Line {
    /// Whether it is known to be within its budget.
    pub fn is_kept(&self) -> bool {
        self.measured.is_some_and(|measured| measured <= self.budget)
    }
}

impl std::fmt::Display for Line {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { what, unit, measured, budget, of } = self;
        let Some(measured) = measured else {
            return write!(f, "{what:<16}  not measured, budget {budget} {unit}");
        };
        write!(f, "{what:<16}{measured:>8} {unit:<13}budget {budget:>6}")?;
        if let Some(of) = of {
            write!(f, "   {:>4.1} % of {of}", 100.0 * *measured as f64 / *of as f64)?;
        }
        write!(f, "{}", if self.is_kept() { "" } else { "   OVER BUDGET" })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checkouts_budgets_fit_the_chip() {
        let budgets = Budgets::of_checkout().unwrap();
        assert!(budgets.flash_bytes <= crate::image::size::FLASH_BYTES);
        assert!(budgets.ram_bytes + budgets.stack_bytes <= crate::image::size::RAM_BYTES);
    }

    #[test]
    fn what_was_not_measured_is_not_kept() {
        let line = Line { what: "flash", unit: "bytes", measured: None, budget: 10, of: None };
        assert!(!line.is_kept());
        assert!(Line { measured: Some(10), ..line.clone() }.is_kept());
        assert!(!Line { measured: Some(11), ..line }.is_kept());
    }
}
