//! The recipe of a recording.

use std::path::Path;

use anyhow::{Context, Result};

use super::{Recipe, Recording};
use crate::recipe::{Kind, Named, RecipeError};

/// The recipe to play a recording with: the one that was asked for, by file or by name; else the one that its name calls
/// for, unless its columns already are channels.
pub fn choose(recording: &Recording, path: &Path, asked: Option<&str>) -> Result<Option<Named<Recipe>>> {
    if let Some(asked) = asked {
        return Recipe::asked(asked).map(Some);
    }
    if recording.signals().all(|column| tenax_hal_shim::channel::by_name(column).is_some()) {
        return Ok(None);
    }
    for_recording(path).context("in a recipe of the repository")
}

/// The repository's recipe for a recording of this name, if there is one.
pub fn for_recording(path: &Path) -> Result<Option<Named<Recipe>>, RecipeError> {
    Recipe::for_file(path)
}
