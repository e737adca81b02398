//! An error of a scene file, in one line.

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: {what}")]
pub struct SceneError {
    file: String,
    line: usize,
    what: String,
}

impl SceneError {
    pub(super) fn at(start: usize, what: String, text: &str, file: &str) -> Self {
        let before = text.get(..start).unwrap_or(text);
        Self { file: file.to_owned(), line: before.matches('\n').count() + 1, what }
    }
}
