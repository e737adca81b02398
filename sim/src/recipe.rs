//! What every recipe is: a TOML file that says in which line it is wrong, and which files it is for by their names.

use std::fmt::Display;
use std::ops::Range;
use std::path::Path;

use anyhow::bail;
use serde::de::DeserializeOwned;
use thiserror::Error;
use toml::Spanned;

#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{file}:{line}: {what}")]
pub struct RecipeError {
    pub file: String,
    /// Line in it, from 1.
    pub line: usize,
    pub what: String,
}

pub type Checked = Result<(), (Range<usize>, String)>;

pub trait Kind: DeserializeOwned + 'static {
    /// Name and text of every one in `recipes/`.
    const BUILTIN: &'static [(&'static str, &'static str)];

    /// Names of the files that it is taken for when no recipe is given; `*` and `?` match as in a shell.
    fn applies_to(&self) -> &[Spanned<String>];

    fn check(&self) -> Checked;

    fn parse(text: &str, file: &str) -> Result<Self, RecipeError> {
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

    fn asked(asked: &str) -> anyhow::Result<Named<Self>> {
        let name = asked.to_owned();
        if let Some((_, text)) = Self::BUILTIN.iter().find(|(name, _)| *name == asked) {
            return Ok(Named { name, recipe: Self::parse(text, &format!("recipes/{asked}.toml"))? });
        }
        let file = Path::new(asked);
        if !file.exists() {
            bail!(
                "--recipe {asked}: no such file, and no recipe for this is called that; those are {}",
                Self::names()
            );
        }
        let text =
            crate::input::text(file).map_err(|error| anyhow::anyhow!("{asked}: cannot be read: {error}"))?;
        Ok(Named { name, recipe: Self::parse(&text, asked)? })
    }

    fn for_file(path: &Path) -> Result<Option<Named<Self>>, RecipeError> {
        let file_name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
        for (name, text) in Self::BUILTIN {
            let recipe = Self::parse(text, &format!("recipes/{name}.toml"))?;
            if recipe.is_for(&file_name) {
                return Ok(Some(Named { name: (*name).to_owned(), recipe }));
            }
        }
        Ok(None)
    }

    fn is_for(&self, file_name: &str) -> bool {
        matches(self.applies_to(), file_name)
    }

    fn names() -> String {
        Self::BUILTIN.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ")
    }
}

#[derive(Clone, Debug)]
pub struct Named<R> {
    pub name: String,
    pub recipe: R,
}

/// A factor of 1, for a value that is not given: it has no place in the file, and is never wrong.
pub fn one() -> Spanned<f64> {
    Spanned::new(0..0, 1.0)
}

pub fn within<T: PartialOrd + Display>(value: &Spanned<T>, name: &str, low: T, high: T) -> Checked {
    let own = value.get_ref();
    if *own >= low && *own <= high {
        return Ok(());
    }
    Err((value.span(), format!("{name} is {own}; {low} to {high} is allowed")))
}

pub fn if_within<T: PartialOrd + Display>(
    value: &Option<Spanned<T>>,
    name: &str,
    low: T,
    high: T,
) -> Checked {
    value.as_ref().map_or(Ok(()), |value| within(value, name, low, high))
}

pub fn check_scale(scale: &Spanned<f64>) -> Checked {
    if scale.get_ref().is_finite() && *scale.get_ref() != 0.0 {
        return Ok(());
    }
    Err((scale.span(), "scale must be a number other than 0".into()))
}

pub fn matches<'p>(patterns: impl IntoIterator<Item = &'p Spanned<String>>, file_name: &str) -> bool {
    let matches = |pattern: &Spanned<String>| {
        glob::Pattern::new(pattern.get_ref()).is_ok_and(|pattern| pattern.matches(file_name))
    };
    patterns.into_iter().any(matches)
}

pub fn check_patterns<'p>(patterns: impl IntoIterator<Item = &'p Spanned<String>>) -> Checked {
    for pattern in patterns {
        glob::Pattern::new(pattern.get_ref())
            .map_err(|error| (pattern.span(), format!("`{}` is no pattern: {error}", pattern.get_ref())))?;
    }
    Ok(())
}
