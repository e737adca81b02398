//! `tenax safety`: requirements, hazards and tests, held against each other.

use std::process::ExitCode;

use super::format::Format;
use super::{out, workspace};
use crate::safety::{Matrix, soup};

/// Check requirements, hazards and tests against each other.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Fail also if a test that shows a requirement did not pass in the last `tenax test`
    #[arg(long)]
    tested: bool,
    /// Print docs/safety/soup.md instead: the foreign crates of the image
    #[arg(long, conflicts_with = "tested")]
    soup: bool,
    /// Print docs/safety/tests.txt instead: the tests that show each requirement
    #[arg(long, conflicts_with_all = ["tested", "soup"])]
    named: bool,
    /// How to print the matrix
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
}

const EXAMPLES: &str = "\
Examples:
  tenax safety                      the matrix: requirement, hazards, tests
  tenax test && tenax safety --tested
  tenax safety --soup > docs/safety/soup.md
  tenax safety --named > docs/safety/tests.txt
A test names what it shows in a comment above it: // Shows W1, R2.";

/// Prints the matrix. 1: something is missing.
pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    if args.soup {
        out::say!("{}", soup::page(&workspace::root()?)?.trim_end())?;
        return Ok(ExitCode::SUCCESS);
    }
    let matrix = Matrix::of(&workspace::root()?, args.tested)?;
    if args.named {
        out::say!("{}", matrix.named().trim_end())?;
        return Ok(ExitCode::SUCCESS);
    }
    args.report.print(&matrix, &matrix)?;
    Ok(ExitCode::from(u8::from(!matrix.problems.is_empty())))
}
