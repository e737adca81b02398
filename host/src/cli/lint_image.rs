//! `tenax lint-image`: Clippy on the image's package.

use std::process::ExitCode;

use super::out;
use super::workspace;
use crate::image;

pub fn main() -> anyhow::Result<ExitCode> {
    image::clippy(&workspace::root()?)?;
    out::say!("image: no warnings")?;
    Ok(ExitCode::SUCCESS)
}
