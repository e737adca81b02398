//! Files that somebody gives, read within bounds: neither a device nor the wrong file fills the memory.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

pub const TEXT_MAX_BYTES: u64 = 1_000_000;
pub const LINE_MAX_BYTES: u64 = 100_000;
pub const CSV_MAX_BYTES: u64 = 1_000_000_000;

/// The text of a scene or a recipe. Fails if it cannot be read, is too long, or is no text.
pub fn text(path: &Path) -> io::Result<String> {
    text_of(File::open(path)?)
}

fn text_of(source: impl Read) -> io::Result<String> {
    let mut bytes = Vec::new();
    source.take(TEXT_MAX_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > TEXT_MAX_BYTES {
        return Err(io::Error::other(format!(
            "it is longer than {} MB, the most allowed",
            TEXT_MAX_BYTES / 1_000_000
        )));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes()[..valid].iter().filter(|&&byte| byte == b'\n').count();
        io::Error::other(format!("line {line} is not text (UTF-8)"))
    })
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

pub fn rows<R: Read>(source: R) -> csv::Reader<Rows<R>> {
    csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(Rows::new(source))
}

pub fn number(column: &str, cell: &str) -> Result<f64, String> {
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("column `{column}` is `{cell}`; only finite numbers are allowed")),
        Err(_) => Err(format!("column `{column}` is `{cell}`, which is not a number")),
    }
}

/// The source of a CSV file, cut off where it is longer than allowed.
#[derive(Debug)]
pub struct Rows<R> {
    source: R,
    line: u64,
    in_line: u64,
    in_all: u64,
}

impl<R: Read> Rows<R> {
    pub const fn new(source: R) -> Self {
        Self { source, line: 1, in_line: 0, in_all: 0 }
    }

    fn count(&mut self, bytes: &[u8]) -> io::Result<()> {
        let too_large = |what| Err(io::Error::new(io::ErrorKind::FileTooLarge, what));
        self.in_all += bytes.len() as u64;
        for piece in bytes.split_inclusive(|&byte| byte == b'\n') {
            self.in_line += piece.len() as u64;
            if self.in_line > LINE_MAX_BYTES {
                return too_large(format!("line {} is longer than 100 kB: no row of a CSV file", self.line));
            }
            if piece.ends_with(b"\n") {
                self.line += 1;
                self.in_line = 0;
            }
        }
        if self.in_all > CSV_MAX_BYTES {
            return too_large("the file is longer than 1 GB, the most allowed".to_owned());
        }
        Ok(())
    }
}

impl<R: Read> Read for Rows<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let length = self.source.read(buffer)?;
        self.count(&buffer[..length])?;
        Ok(length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_has_an_end() {
        assert_eq!(text_of(&b"name = 'a'"[..]).unwrap(), "name = 'a'");
        let error = text_of(io::repeat(0)).unwrap_err().to_string();
        assert_eq!(error, "it is longer than 1 MB, the most allowed");
        let error = text_of(&b"a\nb\n\xff"[..]).unwrap_err().to_string();
        assert_eq!(error, "line 3 is not text (UTF-8)");
    }

    #[test]
    fn a_line_has_an_end() {
        let endless = (&b"t,a\n0,1\n"[..]).chain(io::repeat(b'0'));
        let error = Rows::new(endless).read_to_end(&mut Vec::new()).unwrap_err().to_string();
        assert_eq!(error, "line 3 is longer than 100 kB: no row of a CSV file");
    }
}
