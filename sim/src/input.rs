//! Files that somebody gives, read within bounds: neither a device nor the wrong file fills the memory.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

const TEXT_MAX_BYTES: u64 = 1_000_000;
const CSV_MAX_BYTES: u64 = 1_000_000_000;

/// The text of a scene or a recipe. Fails if it cannot be read, is too long, or is no text.
pub fn text(path: &Path) -> io::Result<String> {
    io::read_to_string(Limited::new(File::open(path)?, TEXT_MAX_BYTES))
}

#[derive(Debug, thiserror::Error)]
pub enum CsvError {
    #[error("{file}: cannot be read")]
    Unreadable { file: String, source: io::Error },
    #[error("{file}: {what}")]
    File { file: String, what: String },
    #[error("{file}:{line}: {what}")]
    Row { file: String, line: u64, what: String },
}

impl CsvError {
    pub fn of(file: &str, error: csv::Error) -> Self {
        let line = error.position().map_or(1, csv::Position::line);
        let file = file.to_owned();
        let row = |line, what| Self::Row { file: file.clone(), line, what };
        match error.into_kind() {
            csv::ErrorKind::Io(source) if source.kind() == io::ErrorKind::FileTooLarge => {
                Self::File { file, what: source.to_string() }
            }
            csv::ErrorKind::Io(source) => Self::Unreadable { file, source },
            csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                row(line, format!("{len} cells, but the header has {expected_len}"))
            }
            csv::ErrorKind::Utf8 { err, .. } => row(line, format!("not text (UTF-8): {err}")),
            other => row(line, format!("not CSV: {other:?}")),
        }
    }

    pub fn no_column<'a>(file: &str, why: &str, columns: impl IntoIterator<Item = &'a str>) -> Self {
        let quoted: Vec<String> = columns.into_iter().map(|name| format!("`{name}`")).collect();
        Self::Row {
            file: file.to_owned(),
            line: 1,
            what: format!("{why}; the columns are {}", quoted.join(", ")),
        }
    }
}

pub fn open(path: &Path) -> Result<(File, String), CsvError> {
    let file = path.display().to_string();
    match File::open(path) {
        Ok(source) => Ok((source, file)),
        Err(source) => Err(CsvError::Unreadable { file, source }),
    }
}

pub fn rows<R: Read>(source: R) -> csv::Reader<Limited<R>> {
    let source = Limited::new(source, CSV_MAX_BYTES);
    csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(source)
}

pub fn number(column: &str, cell: &str) -> Result<f64, String> {
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("column `{column}` is `{cell}`; only finite numbers are allowed")),
        Err(_) => Err(format!("column `{column}` is `{cell}`, which is not a number")),
    }
}

/// A source that fails where it is longer than allowed.
#[derive(Debug)]
pub struct Limited<R> {
    source: R,
    most: u64,
    read: u64,
}

impl<R: Read> Limited<R> {
    const fn new(source: R, most: u64) -> Self {
        Self { source, most, read: 0 }
    }
}

impl<R: Read> Read for Limited<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let length = self.source.read(buffer)?;
        self.read += length as u64;
        if self.read > self.most {
            let what = format!("it is longer than {} MB, the most allowed", self.most / 1_000_000);
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, what));
        }
        Ok(length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_an_end() {
        let text = |source: &mut dyn Read| io::read_to_string(Limited::new(source, TEXT_MAX_BYTES));
        assert_eq!(text(&mut &b"name = 'a'"[..]).unwrap(), "name = 'a'");
        let error = text(&mut io::repeat(0)).unwrap_err().to_string();
        assert_eq!(error, "it is longer than 1 MB, the most allowed");
    }
}
