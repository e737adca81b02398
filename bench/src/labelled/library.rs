//! The repository's recipes for labelled recordings of the array, built in.

use std::path::Path;

use anyhow::bail;

use super::ArrayRecipe;

/// Name and text of every such recipe in `recipes/`. A test holds this list against the folder.
pub const BUILTIN: [(&str, &str); 2] = [
    ("array", include_str!("../../../recipes/array.toml")),
    ("biotac", include_str!("../../../recipes/biotac.toml")),
];

/// The recipe to read a file with: the one that was asked for, by file or by name; else the one that its name calls for.
/// Fails if there is none, or it is wrong; says which there are.
pub fn choose(path: &Path, asked: Option<&str>) -> anyhow::Result<ArrayRecipe> {
    let builtin = |(name, text): (&str, &str)| ArrayRecipe::parse(text, &format!("recipes/{name}.toml"));
    if let Some(asked) = asked {
        if let Some(found) = BUILTIN.into_iter().find(|(name, _)| *name == asked) {
            return Ok(builtin(found)?);
        }
        if Path::new(asked).exists() {
            return ArrayRecipe::read(Path::new(asked));
        }
        bail!(
            "--recipe {asked}: no such file, and no recipe for arrays is called that; those are {}",
            names()
        );
    }
    let file_name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
    for recipe in BUILTIN.into_iter().map(builtin) {
        let recipe = recipe?;
        if recipe.is_for(&file_name) {
            return Ok(recipe);
        }
    }
    bail!(
        "{}: no recipe is for files of this name; give --recipe FILE.toml (docs/training.md says how to write one) or one \
         of {}",
        path.display(),
        names()
    )
}

fn names() -> String {
    BUILTIN.map(|(name, _)| name).join(", ")
}
