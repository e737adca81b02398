//! What is wrong with a scene file, in one line.

use std::ops::Range;

/// Where it is wrong, and what is allowed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: {what}")]
pub struct SceneError {
    file: String,
    line: usize,
    what: String,
}

impl SceneError {
    /// The line, counted from 1.
    #[must_use]
    pub const fn line(&self) -> usize {
        self.line
    }

    pub(super) fn at(span: Range<usize>, what: String, text: &str, file_name: &str) -> Self {
        let before = text.get(..span.start).unwrap_or(text);
        let line = before.matches('\n').count() + 1;
        Self { file: file_name.to_owned(), line, what }
    }

    /// `toml` says what is wrong and where, but not with which key: that stands at the line's beginning.
    pub(super) fn from_toml(error: &toml::de::Error, text: &str, file_name: &str) -> Self {
        let span = error.span().unwrap_or(0..0);
        let message = error.message().replace('\n', "; ");
        let line = text.get(..span.start).map_or("", |before| before.rsplit('\n').next().unwrap_or(""));
        let what = match line.split_once('=') {
            Some((key, _)) => format!("{}: {message}", key.trim()),
            None => message,
        };
        Self::at(span, what, text, file_name)
    }
}
