//! Recipes by their names, or for a recording by its name; and a recording with its recipe.

use std::ops::Range;
use std::path::Path;

use anyhow::{Context, Result, bail};
use thiserror::Error;

use super::recipe::matches;
use super::{Recipe, Recording};

#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{file}:{line}: {what}")]
pub struct RecipeError {
    pub file: String,
    /// Line in it, from 1.
    pub line: usize,
    pub what: String,
}

#[derive(Clone, Debug)]
pub struct Named {
    pub name: String,
    pub recipe: Recipe,
}

impl Recipe {
    /// Name and text of every one in `recipes/`.
    pub const BUILTIN: &'static [(&'static str, &'static str)] = &[
        ("emg_bursts", include_str!("../../recipes/emg_bursts.toml")),
        ("emg_two_channel", include_str!("../../recipes/emg_two_channel.toml")),
        ("friction_rig", include_str!("../../recipes/friction_rig.toml")),
        ("pvdf", include_str!("../../recipes/pvdf.toml")),
    ];

    pub fn parse(text: &str, file: &str) -> Result<Self, RecipeError> {
        let at = |span: Range<usize>, what: String| RecipeError {
            file: file.to_owned(),
            line: text.bytes().take(span.start).filter(|&byte| byte == b'\n').count() + 1,
            what,
        };
        let recipe: Self = toml::from_str(text)
            .map_err(|error| at(error.span().unwrap_or(0..0), error.message().trim().replace('\n', "; ")))?;
        recipe.check().map_err(|(span, what)| at(span, what))?;
        Ok(recipe)
    }

    fn builtin() -> impl Iterator<Item = Result<Named, RecipeError>> {
        let read = |(name, text): &(&str, &str)| {
            Ok(Named {
                name: (*name).to_owned(),
                recipe: Self::parse(text, &format!("recipes/{name}.toml"))?,
            })
        };
        Self::BUILTIN.iter().map(read)
    }

    pub fn asked(asked: &str) -> Result<Named> {
        for named in Self::builtin() {
            let named = named?;
            if named.name == asked {
                return Ok(named);
            }
        }
        let file = Path::new(asked);
        if !file.exists() {
            let names: Vec<&str> = Self::BUILTIN.iter().map(|(name, _)| *name).collect();
            bail!(
                "--recipe {asked}: no such file, and no recipe for this is called that; those are {}",
                names.join(", ")
            );
        }
        let text = crate::input::text(file).with_context(|| format!("{asked}: cannot be read"))?;
        Ok(Named { name: asked.to_owned(), recipe: Self::parse(&text, asked)? })
    }

    pub fn for_file(path: &Path) -> Result<Option<Named>, RecipeError> {
        let file_name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
        let is_for = |named: &Result<Named, RecipeError>| {
            named.as_ref().map_or(true, |named| matches(&named.recipe.applies_to, &file_name))
        };
        Self::builtin().find(is_for).transpose()
    }
}

pub fn read(path: &Path, asked: Option<&str>) -> Result<(Recording, Option<Named>)> {
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
