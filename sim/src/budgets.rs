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
