//! How a report is printed.

use std::fmt::Display;

use clap::ValueEnum;
use serde::Serialize;

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
    ///
    /// # Errors
    /// If the report cannot be written as JSON.
    pub fn print(self, text: &impl Display, report: &impl Serialize) -> serde_json::Result<()> {
        match self {
            Self::Text => print!("{text}"),
            Self::Json => println!("{}", serde_json::to_string_pretty(report)?),
        }
        Ok(())
    }
}
