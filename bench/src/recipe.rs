//! What every recipe is: a TOML file that says in which line it is wrong, and which files it is for by their names.

use std::ops::Range;
use std::path::Path;

use serde::de::DeserializeOwned;
use thiserror::Error;
use toml::Spanned;

/// What is wrong with a recipe, and where.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{file}:{line}: {what}")]
pub struct RecipeError {
    /// The recipe.
    pub file: String,
    /// Line in it, from 1.
    pub line: usize,
    /// What, and what is allowed.
    pub what: String,
}

/// What a check finds: the place in the text, and what is wrong there.
pub type Checked = Result<(), (Range<usize>, String)>;

/// Reads a recipe file; `parse` is told its text and what errors call it.
pub fn read<R>(path: &Path, parse: impl FnOnce(&str, &str) -> Result<R, RecipeError>) -> anyhow::Result<R> {
    let file = path.display().to_string();
    let text =
        crate::input::text(path).map_err(|error| anyhow::anyhow!("{file}: cannot be read: {error}"))?;
    Ok(parse(&text, &file)?)
}

/// Reads and checks a recipe; `file` is what errors call it.
pub fn parse<R: DeserializeOwned>(
    text: &str,
    file: &str,
    check: impl FnOnce(&R) -> Checked,
) -> Result<R, RecipeError> {
    let at = |span: Range<usize>, what: String| RecipeError {
        file: file.to_owned(),
        line: text.bytes().take(span.start).filter(|&byte| byte == b'\n').count() + 1,
        what,
    };
    let recipe: R = toml::from_str(text)
        .map_err(|error| at(error.span().unwrap_or(0..0), error.message().trim().replace('\n', "; ")))?;
    check(&recipe).map_err(|(span, what)| at(span, what))?;
    Ok(recipe)
}

/// Whether any of these patterns is of this name; `*` and `?` match as in a shell.
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
