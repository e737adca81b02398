//! A recording: a CSV file with a time column and one column a signal.

use std::io::Read;
use std::ops::RangeInclusive;
use std::path::Path;

use csv::StringRecord;

use super::recipe::Time;
use crate::input::{CsvError, number, open, rows};

const TIME_COLUMNS: [&str; 2] = ["t", "t_s"];
const LONGEST_S: f64 = 600.0;

#[derive(Clone, Debug)]
pub struct Recording {
    file: String,
    columns: Vec<String>,
    time: usize,
    t_s: Vec<f64>,
    signals: Vec<Signal>,
}

/// Values of a column, or the line and the message of its first mistake: a column of words which nobody maps does no harm.
type Signal = Result<Vec<f64>, (u64, String)>;

impl Recording {
    pub fn read(path: &Path, time: &Time) -> Result<Self, CsvError> {
        let (source, file) = open(path)?;
        Self::timed(source, &file, time)
    }

    pub fn parse(source: impl Read, file: &str) -> Result<Self, CsvError> {
        Self::timed(source, file, &Time::default())
    }

    pub fn timed(source: impl Read, file: &str, time: &Time) -> Result<Self, CsvError> {
        let too_short = |rows| {
            let what = format!("{rows} rows of samples; a recording has a header line and at least two rows");
            Err(CsvError::File { file: file.to_owned(), what })
        };
        let mut reader = rows(source);
        let header = reader.headers().map_err(|error| CsvError::of(file, error))?;
        let columns: Vec<String> = header.iter().map(str::to_owned).collect();
        if columns.is_empty() {
            return too_short(0);
        }
        for (index, column) in columns.iter().enumerate() {
            if columns[..index].contains(column) {
                let what = format!("two columns are called `{column}`");
                return Err(CsvError::Row { file: file.to_owned(), line: 1, what });
            }
        }
        let signals = vec![Ok(Vec::new()); columns.len()];
        let mut recording = Self { file: file.to_owned(), columns, time: 0, t_s: Vec::new(), signals };
        recording.time = match &time.column {
            Some(name) => recording
                .place(name)
                .ok_or_else(|| recording.no_column(&format!("no time column `{name}`, which the recipe names")))?,
            None => TIME_COLUMNS.iter().find_map(|name| recording.place(name)).ok_or_else(|| {
                recording.no_column(
                    "no time column: one must be called `t` or `t_s` and hold seconds, or a recipe's [time] names another",
                )
            })?,
        };
        let mut row = StringRecord::new();
        // Of a recording that is too long, only the time is read on: the error says how long it is.
        let mut too_long_s = None;
        while reader.read_record(&mut row).map_err(|error| CsvError::of(file, error))? {
            let line = row.position().map_or(0, csv::Position::line);
            let t_s = recording.time_s(&row[recording.time], line, time)?;
            let first_s = *recording.t_s.first().unwrap_or(&t_s);
            if t_s - first_s > LONGEST_S {
                too_long_s = Some(t_s - first_s);
                continue;
            }
            recording.t_s.push(t_s);
            for ((signal, column), cell) in recording.signals.iter_mut().zip(&recording.columns).zip(&row) {
                if let Ok(values) = signal {
                    match number(column, cell) {
                        Ok(value) => values.push(value),
                        Err(what) => *signal = Err((line, what)),
                    }
                }
            }
        }
        let rows = recording.t_s.len();
        match too_long_s {
            Some(duration_s) => {
                let what = format!(
                    "lasts {duration_s:.0} s and {LONGEST_S:.0} s is the longest allowed; is its time in seconds? (if not, a \
                     recipe says: [time] unit = \"ms\")"
                );
                Err(CsvError::File { file: recording.file, what })
            }
            None if rows < 2 => too_short(rows),
            None => Ok(recording),
        }
    }

    fn time_s(&self, cell: &str, line: u64, time: &Time) -> Result<f64, CsvError> {
        let wrong = |what| CsvError::Row { file: self.file.clone(), line, what };
        let t_s = number(&self.columns[self.time], cell).map_err(wrong)? / time.unit.in_a_second();
        match self.t_s.last() {
            Some(&last_s) if t_s < last_s => Err(wrong(format!(
                "time goes backwards, from {last_s} s to {t_s} s; rows must be in order of time"
            ))),
            _ => Ok(t_s),
        }
    }

    pub fn file(&self) -> &str {
        &self.file
    }

    pub fn signals(&self) -> impl Iterator<Item = &str> {
        let of_signals = self.columns.iter().enumerate().filter(|&(place, _)| place != self.time);
        of_signals.map(|(_, column)| column.as_str())
    }

    pub fn t_s(&self) -> &[f64] {
        &self.t_s
    }

    pub fn first_s(&self) -> f64 {
        self.t_s[0]
    }

    pub fn span_s(&self) -> RangeInclusive<f64> {
        self.first_s()..=self.t_s[self.t_s.len() - 1]
    }

    pub fn duration_s(&self) -> f64 {
        self.t_s[self.t_s.len() - 1] - self.t_s[0]
    }

    pub fn longest_gap_s(&self) -> f64 {
        self.t_s.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
    }

    /// Rows a second, on average. Infinite where all rows have one time stamp.
    pub fn rate_hz(&self) -> f64 {
        (self.t_s.len() - 1) as f64 / self.duration_s()
    }

    pub fn series(&self, column: &str) -> Result<Vec<f64>, CsvError> {
        let Some(place) = self.place(column) else {
            return Err(self.no_column(&format!("no column `{column}`")));
        };
        let row = |(line, what)| CsvError::Row { file: self.file.clone(), line, what };
        self.signals[place].clone().map_err(row)
    }

    fn place(&self, column: &str) -> Option<usize> {
        self.columns.iter().position(|name| name == column)
    }

    fn no_column(&self, why: &str) -> CsvError {
        CsvError::no_column(&self.file, why, self.columns.iter().map(String::as_str))
    }
}
