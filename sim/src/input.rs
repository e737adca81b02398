//! Files that somebody gives, read within bounds: neither a device nor the wrong file fills the memory.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use serde::Deserialize;

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

    pub fn no_column<'a>(
        file: &str,
        why: &str,
        columns: impl IntoIterator<Item = &'a str>,
        hint: &str,
    ) -> Self {
        let quoted: Vec<String> = columns.into_iter().map(|name| format!("`{name}`")).collect();
        Self::Row {
            file: file.to_owned(),
            line: 1,
            what: format!("{why}; the columns are {}{hint}", quoted.join(", ")),
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

/// How a table is written: a recipe's `[table]`.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(deny_unknown_fields, default)]
pub struct Table {
    pub delimiter: char,
    pub decimal: char,
    /// Begins lines that are skipped. `%` lines above the header are skipped as well.
    pub comment: char,
    /// False: the columns are called `column_1`, `column_2`, and so on.
    pub header: bool,
}

impl Default for Table {
    fn default() -> Self {
        Self { delimiter: ',', decimal: '.', comment: '#', header: true }
    }
}

impl Table {
    /// Fails if a sign is given two meanings, or is not one byte.
    pub fn check(&self) -> Result<(), String> {
        let signs = [self.delimiter, self.decimal, self.comment];
        match signs.iter().all(char::is_ascii) && (1..3).all(|n| !signs[..n].contains(&signs[n])) {
            true if ['.', ','].contains(&self.decimal) => Ok(()),
            true => Err("decimal is \".\" or \",\"".into()),
            false => Err("delimiter, decimal and comment are three different signs of ASCII".into()),
        }
    }

    pub fn number(&self, column: &str, cell: &str) -> Result<f64, String> {
        let value = if self.decimal == ',' { cell.replace(',', ".").parse() } else { cell.parse::<f64>() };
        match value {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(_) => Err(format!("column `{column}` is `{cell}`; only finite numbers are allowed")),
            Err(_) if self.decimal == '.' && cell.replacen(',', ".", 1).parse::<f64>().is_ok() => {
                Err(format!(
                    "column `{column}` is `{cell}`, which is not a number; with a decimal comma a recipe says: [table] \
                 decimal = \",\""
                ))
            }
            Err(_) => Err(format!("column `{column}` is `{cell}`, which is not a number")),
        }
    }

    /// Why columns may not be found: what a recipe can say instead.
    pub fn hint(&self, columns: &[String]) -> String {
        let all = columns.join(&self.delimiter.to_string());
        let other = [';', '\t', ','].into_iter().find(|sign| *sign != self.delimiter && all.contains(*sign));
        let is_number = |cell: &String| cell.replace(',', ".").parse::<f64>().is_ok();
        match other {
            Some(sign) => format!(
                ". If {sign:?} stands between cells, a recipe says: [table] delimiter = {:?}",
                sign.to_string()
            ),
            None if self.header && columns.iter().all(is_number) => {
                ". If there is no header, a recipe says: [table] header = false".to_owned()
            }
            None => String::new(),
        }
    }
}

pub fn rows<R: Read>(source: R, table: &Table) -> io::Result<csv::Reader<impl Read + use<R>>> {
    let source = past_head(BufReader::new(Limited::new(source, CSV_MAX_BYTES)), table)?;
    let mut builder = csv::ReaderBuilder::new();
    builder.trim(csv::Trim::All).comment(Some(table.comment as u8)).delimiter(table.delimiter as u8);
    Ok(builder.has_headers(table.header).from_reader(source))
}

/// Makes comments of the `%` lines above the header. ROS begins the header itself so: it has as many cells as the line below.
fn past_head<R: BufRead>(mut source: R, table: &Table) -> io::Result<impl Read + use<R>> {
    let mut head: Vec<Vec<u8>> = Vec::new();
    while head.last().is_none_or(|line| line.starts_with(b"%")) {
        let mut line = Vec::new();
        source.read_until(b'\n', &mut line)?;
        // A byte order mark hides what a line begins with.
        head.push(line.strip_prefix(b"\xef\xbb\xbf").map_or_else(|| line.clone(), <[u8]>::to_vec));
    }
    let cells = |line: &[u8]| line.iter().filter(|&&byte| byte == table.delimiter as u8).count();
    for n in 0..head.len() - 1 {
        let is_header = n + 2 == head.len() && cells(&head[n]) > 0 && cells(&head[n]) == cells(&head[n + 1]);
        if !is_header {
            head[n][0] = table.comment as u8;
        }
    }
    Ok(io::Cursor::new(head.concat()).chain(source))
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
