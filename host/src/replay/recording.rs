//! A recording: a CSV file with a time column and one column a signal.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use csv::StringRecord;
use thiserror::Error;

/// Names under which the time column is looked for.
const TIME_COLUMNS: [&str; 2] = ["t", "t_s"];
/// The longest recording that is played, s. A longer one is nearly always one whose time is in milliseconds.
const LONGEST_S: f64 = 600.0;

/// What is wrong with a recording, and where.
#[derive(Debug, Error)]
pub enum RecordingError {
    /// The file cannot be opened or read.
    #[error("{file}: cannot be read")]
    Unreadable {
        /// The recording.
        file: String,
        /// Why not.
        source: std::io::Error,
    },
    /// No header, or fewer than two rows below it.
    #[error("{file}: {rows} rows of samples; a recording has a header line and at least two rows")]
    TooShort {
        /// The recording.
        file: String,
        /// Rows below the header.
        rows: usize,
    },
    /// No time column.
    #[error(
        "{file}:1: no time column: one must be called `t` or `t_s` and hold seconds; the columns are {columns}"
    )]
    NoTime {
        /// The recording.
        file: String,
        /// What it has instead.
        columns: String,
    },
    /// A column that somebody asked for is not there.
    #[error("{file}:1: no column `{column}`; the columns are {columns}")]
    NoColumn {
        /// The recording.
        file: String,
        /// What was asked for.
        column: String,
        /// What it has instead.
        columns: String,
    },
    /// Two columns of one name.
    #[error("{file}:1: two columns are called `{column}`")]
    TwiceTheSameColumn {
        /// The recording.
        file: String,
        /// The name.
        column: String,
    },
    /// Something about a row.
    #[error("{file}:{line}: {what}")]
    Row {
        /// The recording.
        file: String,
        /// Line in the file, from 1; the header is line 1.
        line: u64,
        /// What.
        what: String,
    },
    /// Longer than can be meant.
    #[error(
        "{file}: lasts {duration_s:.0} s and {LONGEST_S:.0} s is the longest allowed; is its time in seconds? (divide \
         milliseconds by 1000)"
    )]
    TooLong {
        /// The recording.
        file: String,
        /// From its first to its last row, s.
        duration_s: f64,
    },
}

/// A recording. Signals are parsed when asked for, so that a column of words which nobody maps does no harm.
#[derive(Clone, Debug)]
pub struct Recording {
    file: String,
    columns: Vec<String>,
    t_s: Vec<f64>,
    rows: Vec<StringRecord>,
}

impl Recording {
    /// Reads a file.
    pub fn read(path: &Path) -> Result<Self, RecordingError> {
        let name = path.display().to_string();
        let file =
            File::open(path).map_err(|source| RecordingError::Unreadable { file: name.clone(), source })?;
        Self::parse(file, &name)
    }

    /// Reads from anything; `file` is what errors call it.
    pub fn parse(source: impl Read, file: &str) -> Result<Self, RecordingError> {
        let file = file.to_owned();
        let mut reader =
            csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(source);
        let header = reader.headers().map_err(|error| from_csv(&file, error))?;
        let columns: Vec<String> = header.iter().map(str::to_owned).collect();
        for (index, column) in columns.iter().enumerate() {
            if columns[..index].contains(column) {
                return Err(RecordingError::TwiceTheSameColumn { file, column: column.clone() });
            }
        }
        let rows: Vec<StringRecord> =
            reader.into_records().collect::<Result<_, _>>().map_err(|error| from_csv(&file, error))?;
        if rows.len() < 2 {
            return Err(RecordingError::TooShort { file, rows: rows.len() });
        }
        let mut recording = Self { file, columns, t_s: Vec::new(), rows };
        let Some(time) = TIME_COLUMNS.iter().find(|name| recording.has(name)) else {
            return Err(RecordingError::NoTime { columns: recording.column_list(), file: recording.file });
        };
        recording.t_s = recording.series(time)?;
        recording.check_time()?;
        Ok(recording)
    }

    fn check_time(&self) -> Result<(), RecordingError> {
        for (index, pair) in self.t_s.windows(2).enumerate() {
            if pair[1] < pair[0] {
                return Err(RecordingError::Row {
                    file: self.file.clone(),
                    line: self.line(index + 1),
                    what: format!(
                        "time goes backwards, from {} s to {} s; rows must be in order of time",
                        pair[0], pair[1]
                    ),
                });
            }
        }
        if self.duration_s() > LONGEST_S {
            return Err(RecordingError::TooLong { file: self.file.clone(), duration_s: self.duration_s() });
        }
        Ok(())
    }

    /// The file, as errors call it.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The columns, the time column not among them.
    pub fn signals(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(String::as_str).filter(|column| !TIME_COLUMNS.contains(column))
    }

    /// Time stamps, s, never decreasing, at least two.
    #[must_use]
    pub fn t_s(&self) -> &[f64] {
        &self.t_s
    }

    /// The first time stamp, s.
    #[must_use]
    pub fn first_s(&self) -> f64 {
        self.t_s[0]
    }

    /// From the first to the last row, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.t_s[self.t_s.len() - 1] - self.t_s[0]
    }

    /// The longest time between two rows, s. Between rows a signal is a straight line, so a long one is worth saying.
    #[must_use]
    pub fn longest_gap_s(&self) -> f64 {
        self.t_s.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
    }

    /// Rows a second, on average. Infinite where all rows have one time stamp.
    #[must_use]
    pub fn rate_hz(&self) -> f64 {
        (self.t_s.len() - 1) as f64 / self.duration_s()
    }

    /// The values of a column, one a row.
    pub fn series(&self, column: &str) -> Result<Vec<f64>, RecordingError> {
        let Some(place) = self.columns.iter().position(|name| name == column) else {
            return Err(RecordingError::NoColumn {
                file: self.file.clone(),
                column: column.to_owned(),
                columns: self.column_list(),
            });
        };
        self.rows
            .iter()
            .enumerate()
            .map(|(row, cells)| {
                let text = &cells[place];
                let error =
                    |what| RecordingError::Row { file: self.file.clone(), line: self.line(row), what };
                match text.parse::<f64>() {
                    Ok(value) if value.is_finite() => Ok(value),
                    Ok(_) => {
                        Err(error(format!("column `{column}` is `{text}`; only finite numbers are allowed")))
                    }
                    Err(_) => Err(error(format!("column `{column}` is `{text}`, which is not a number"))),
                }
            })
            .collect()
    }

    fn has(&self, column: &str) -> bool {
        self.columns.iter().any(|name| name == column)
    }

    fn column_list(&self) -> String {
        let quoted: Vec<String> = self.columns.iter().map(|name| format!("`{name}`")).collect();
        quoted.join(", ")
    }

    fn line(&self, row: usize) -> u64 {
        self.rows[row].position().map_or(0, csv::Position::line)
    }
}

/// The csv crate's error as one of ours: what, and in which line.
fn from_csv(file: &str, error: csv::Error) -> RecordingError {
    let line = error.position().map_or(1, csv::Position::line);
    let file = file.to_owned();
    match error.into_kind() {
        csv::ErrorKind::Io(source) => RecordingError::Unreadable { file, source },
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => RecordingError::Row {
            file,
            line,
            what: format!("{len} cells, but the header has {expected_len}"),
        },
        csv::ErrorKind::Utf8 { err, .. } => {
            RecordingError::Row { file, line, what: format!("not text (UTF-8): {err}") }
        }
        other => RecordingError::Row { file, line, what: format!("not CSV: {other:?}") },
    }
}
