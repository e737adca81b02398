//! `budgets.toml`: what the image may take of the chip, and the lines of each folder.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use serde::Deserialize;

#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Budgets {
    pub flash_bytes: u64,
    pub ram_bytes: u64,
    pub stack_bytes: u64,
    pub tick_instructions_mean: u64,
    pub tick_instructions_max: u64,
    /// Everything that the core executes in a period of 0.5 ms, mean.
    pub period_instructions_mean: u64,
    /// Lines of source by folder of the checkout.
    pub lines: BTreeMap<String, u64>,
}

impl Budgets {
    pub fn of_checkout() -> Result<Self> {
        toml::from_str(include_str!("../../budgets.toml")).context("budgets.toml")
    }
}

#[derive(Clone, Debug)]
pub struct Line {
    pub what: &'static str,
    pub unit: &'static str,
    /// What was measured, None where it could not be.
    pub measured: Option<u64>,
    pub budget: u64,
    pub of: Option<u64>,
}

impl Line {
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
}
