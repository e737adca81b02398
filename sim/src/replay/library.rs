//! A recording and its recipe.

use std::path::Path;

use anyhow::{Context, Result};

use super::{Recipe, Recording};
use crate::recipe::{Kind, Named};

pub fn read(path: &Path, asked: Option<&str>) -> Result<(Recording, Option<Named<Recipe>>)> {
    let named = match asked {
        Some(asked) => Some(Recipe::asked(asked)?),
        None => Recipe::for_file(path).context("in a recipe of the repository")?,
    };
    let (table, time) = named
        .as_ref()
        .map_or_else(Default::default, |named| (named.recipe.table(), named.recipe.time.clone()));
    let recording = Recording::read(path, &table, &time)?;
    let is_channel = |column: &str| tenax_hal_shim::channel::by_name(column).is_some();
    let is_plain = asked.is_none() && recording.signals().all(is_channel);
    Ok((recording, named.filter(|_| !is_plain)))
}
