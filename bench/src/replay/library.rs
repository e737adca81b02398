//! The recipes of the repository, built in, so that the tool finds them wherever it is run.

use std::path::Path;

use anyhow::{Context, bail};

use super::{Recipe, Recording};
use crate::recipe::RecipeError;

/// Name and text of every recipe in `recipes/`. A test holds this list against the folder.
pub const BUILTIN: [(&str, &str); 4] = [
    ("emg_bursts", include_str!("../../../recipes/emg_bursts.toml")),
    ("emg_two_channel", include_str!("../../../recipes/emg_two_channel.toml")),
    ("friction_rig", include_str!("../../../recipes/friction_rig.toml")),
    ("pvdf", include_str!("../../../recipes/pvdf.toml")),
];

/// A recipe and what it is called.
#[derive(Clone, Debug)]
pub struct Named {
    /// Its name here, or its file.
    pub name: String,
    pub recipe: Recipe,
}

/// A recipe of the repository.
pub fn builtin(name: &str) -> Option<Result<Named, RecipeError>> {
    let (name, text) = BUILTIN.iter().find(|(own, _)| *own == name)?;
    Some(
        Recipe::parse(text, &format!("recipes/{name}.toml"))
            .map(|recipe| Named { name: (*name).to_owned(), recipe }),
    )
}

/// The repository's recipe for a recording of this name, if there is one.
pub fn for_recording(path: &Path) -> Result<Option<Named>, RecipeError> {
    let Some(file_name) = path.file_name().map(|name| name.to_string_lossy()) else {
        return Ok(None);
    };
    for named in BUILTIN.iter().filter_map(|(name, _)| builtin(name)) {
        let named = named?;
        if named.recipe.is_for(&file_name) {
            return Ok(Some(named));
        }
    }
    Ok(None)
}

/// The recipe to play a recording with: the one that was asked for, by file or by name; else the one that its name calls
/// for, unless its columns already are channels.
pub fn choose(recording: &Recording, path: &Path, asked: Option<&str>) -> anyhow::Result<Option<Named>> {
    if let Some(asked) = asked {
        if let Some(named) = builtin(asked) {
            return Ok(Some(named?));
        }
        let file = Path::new(asked);
        if !file.exists() {
            let names: Vec<&str> = BUILTIN.iter().map(|(name, _)| *name).collect();
            bail!(
                "--recipe {asked}: no such file, and no recipe of the repository is called that; those are {}",
                names.join(", ")
            );
        }
        return Ok(Some(Named { name: asked.to_owned(), recipe: Recipe::read(file)? }));
    }
    let plain = recording.signals().all(|column| tenax_hal_shim::channel::by_name(column).is_some());
    if plain {
        return Ok(None);
    }
    for_recording(path).context("in a recipe of the repository")
}
