//! How a report is printed.

use std::fmt::Display;

use clap::ValueEnum;
use serde::Serialize;

use super::out;

/// The two ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For people
    Text,
    /// For programs
    Json,
}

impl Format {
    /// Prints a report on stdout: as `text`, or as the keys and numbers of `report`.
    /// Fails if the report cannot be written as JSON, or not printed.
    pub fn print(self, text: &impl Display, report: &impl Serialize) -> anyhow::Result<()> {
        match self {
            Self::Text => out::print(format_args!("{text}")),
            Self::Json => out::say!("{}", serde_json::to_string_pretty(report)?),
        }
    }
}
