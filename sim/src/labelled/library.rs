//! The recipe of a labelled recording of the array.

use std::path::Path;

use anyhow::{Context, Result};

use super::ArrayRecipe;
use crate::recipe::Kind;

/// The recipe that was asked for, by file or by name; else the one that the file's name calls for. Fails if there is none.
pub fn choose(path: &Path, asked: Option<&str>) -> Result<ArrayRecipe> {
    if let Some(asked) = asked {
        return Ok(ArrayRecipe::asked(asked)?.recipe);
    }
    let named = ArrayRecipe::for_file(path)?.with_context(|| {
        format!(
            "{}: no recipe is for files of this name; give --recipe FILE.toml (docs/array.md says how to write one) or one \
             of {}",
            path.display(),
            ArrayRecipe::names()
        )
    })?;
    Ok(named.recipe)
}
