//! A recording: a CSV file with a time column and one column a signal.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use csv::StringRecord;
use thiserror::Error;

use crate::input::{Rows, TooLong, too_long};

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

/// A recording. Its rows are read one by one, and only numbers are kept.
#[derive(Clone, Debug)]
pub struct Recording {
    file: String,
    columns: Vec<String>,
    t_s: Vec<f64>,
    signals: Vec<Signal>,
}

/// A column. What is wrong in it is said when it is asked for, so that a column of words which nobody maps does no harm.
#[derive(Clone, Debug, Default)]
struct Signal {
    values: Vec<f64>,
    /// The first cell that is no finite number: its line, and what is wrong.
    wrong: Option<(u64, String)>,
}

impl Signal {
    fn take(&mut self, column: &str, cell: &str, line: u64) {
        if self.wrong.is_some() {
            return;
        }
        match number(column, cell) {
            Ok(value) => self.values.push(value),
            Err(what) => {
                self.wrong = Some((line, what));
                self.values = Vec::new();
            }
        }
    }
}

/// A cell's number.
fn number(column: &str, text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("column `{column}` is `{text}`; only finite numbers are allowed")),
        Err(_) => Err(format!("column `{column}` is `{text}`, which is not a number")),
    }
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
            csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(Rows::new(source));
        let header = reader.headers().map_err(|error| from_csv(&file, error))?;
        let columns: Vec<String> = header.iter().map(str::to_owned).collect();
        if columns.is_empty() {
            return Err(RecordingError::TooShort { file, rows: 0 });
        }
        for (index, column) in columns.iter().enumerate() {
            if columns[..index].contains(column) {
                return Err(RecordingError::TwiceTheSameColumn { file, column: column.clone() });
            }
        }
        let signals = vec![Signal::default(); columns.len()];
        let mut recording = Self { file, columns, t_s: Vec::new(), signals };
        let place = TIME_COLUMNS.iter().find_map(|name| recording.place(name));
        let mut row = StringRecord::new();
        // Of a recording that is too long, only the time is read on: the error says how long it is.
        let mut too_long_s = None;
        while reader.read_record(&mut row).map_err(|error| from_csv(&recording.file, error))? {
            let Some(place) = place else {
                return Err(RecordingError::NoTime {
                    columns: recording.column_list(),
                    file: recording.file,
                });
            };
            let line = row.position().map_or(0, csv::Position::line);
            let t_s = recording.time_s(place, &row[place], line)?;
            let first_s = *recording.t_s.first().unwrap_or(&t_s);
            if t_s - first_s > LONGEST_S {
                too_long_s = Some(t_s - first_s);
                continue;
            }
            recording.t_s.push(t_s);
            for ((signal, column), cell) in recording.signals.iter_mut().zip(&recording.columns).zip(&row) {
                signal.take(column, cell, line);
            }
        }
        let rows = recording.t_s.len();
        match too_long_s {
            Some(duration_s) => Err(RecordingError::TooLong { file: recording.file, duration_s }),
            None if rows < 2 => Err(RecordingError::TooShort { file: recording.file, rows }),
            None => Ok(recording),
        }
    }

    /// The time stamp of the next row, which may not be earlier than the last one's.
    fn time_s(&self, place: usize, cell: &str, line: u64) -> Result<f64, RecordingError> {
        let wrong = |what| RecordingError::Row { file: self.file.clone(), line, what };
        let t_s = number(&self.columns[place], cell).map_err(wrong)?;
        match self.t_s.last() {
            Some(&last_s) if t_s < last_s => Err(wrong(format!(
                "time goes backwards, from {last_s} s to {t_s} s; rows must be in order of time"
            ))),
            _ => Ok(t_s),
        }
    }

    /// The file, as errors call it.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The columns, the time column not among them.
    pub fn signals(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(String::as_str).filter(|column| !TIME_COLUMNS.contains(column))
    }

    /// Time stamps, s, never decreasing, at least two.
    pub fn t_s(&self) -> &[f64] {
        &self.t_s
    }

    /// The first time stamp, s.
    pub fn first_s(&self) -> f64 {
        self.t_s[0]
    }

    /// From the first to the last row, s.
    pub fn duration_s(&self) -> f64 {
        self.t_s[self.t_s.len() - 1] - self.t_s[0]
    }

    /// The longest time between two rows, s. Between rows a signal is a straight line, so a long one is worth saying.
    pub fn longest_gap_s(&self) -> f64 {
        self.t_s.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
    }

    /// Rows a second, on average. Infinite where all rows have one time stamp.
    pub fn rate_hz(&self) -> f64 {
        (self.t_s.len() - 1) as f64 / self.duration_s()
    }

    /// The values of a column, one a row.
    pub fn series(&self, column: &str) -> Result<Vec<f64>, RecordingError> {
        let Some(place) = self.place(column) else {
            return Err(RecordingError::NoColumn {
                file: self.file.clone(),
                column: column.to_owned(),
                columns: self.column_list(),
            });
        };
        let signal = &self.signals[place];
        match &signal.wrong {
            Some((line, what)) => {
                Err(RecordingError::Row { file: self.file.clone(), line: *line, what: what.clone() })
            }
            None => Ok(signal.values.clone()),
        }
    }

    fn place(&self, column: &str) -> Option<usize> {
        self.columns.iter().position(|name| name == column)
    }

    fn column_list(&self) -> String {
        let quoted: Vec<String> = self.columns.iter().map(|name| format!("`{name}`")).collect();
        quoted.join(", ")
    }
}

/// The csv crate's error as one of ours: what, and in which line.
fn from_csv(file: &str, error: csv::Error) -> RecordingError {
    let line = error.position().map_or(1, csv::Position::line);
    let file = file.to_owned();
    match error.into_kind() {
        csv::ErrorKind::Io(source) => match too_long(&source) {
            Some(TooLong { line, what }) => RecordingError::Row { file, line, what: what.to_owned() },
            None => RecordingError::Unreadable { file, source },
        },
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
