//! A recording: a CSV file with a time column and one column a signal.

use std::io::Read;
use std::ops::RangeInclusive;
use std::path::Path;

use csv::StringRecord;
use tenax_frames::quantile::middle;

use super::recipe::Time;
use crate::input::{CsvError, Table, open, rows};

const TIME_COLUMNS: [&str; 2] = ["t", "t_s"];
const LONGEST_S: f64 = 600.0;

#[derive(Clone, Debug)]
pub struct Recording {
    file: String,
    columns: Vec<String>,
    table: Table,
    /// None where a rate stands for it.
    time: Option<usize>,
    t_s: Vec<f64>,
    /// Rows with the stamp of the row before, which were spread evenly.
    equal_stamps: usize,
    signals: Vec<Signal>,
}

/// Values of a column, or the line and the message of its first mistake: a column of words which nobody maps does no harm.
type Signal = Result<Vec<f64>, (u64, String)>;

impl Recording {
    pub fn read(path: &Path, table: &Table, time: &Time) -> Result<Self, CsvError> {
        let (source, file) = open(path)?;
        Self::timed(source, &file, table, time)
    }

    pub fn parse(source: impl Read, file: &str) -> Result<Self, CsvError> {
        Self::timed(source, file, &Table::default(), &Time::default())
    }

    /// A table in memory: times, s, and columns of as many values each.
    pub fn of(file: &str, t_s: Vec<f64>, columns: Vec<(String, Vec<f64>)>) -> Result<Self, CsvError> {
        let wrong = |what: String| Err(CsvError::File { file: file.to_owned(), what });
        if t_s.len() < 2 || t_s.last().is_some_and(|last| last - t_s[0] > LONGEST_S) {
            return wrong(format!("a recording has two rows or more and lasts {LONGEST_S:.0} s at most"));
        }
        if !t_s.is_sorted() || columns.iter().any(|(_, values)| values.len() != t_s.len()) {
            return wrong("times must not go backwards, and every column must have a value for each".into());
        }
        let finite = |values: &Vec<f64>| values.iter().all(|value| value.is_finite());
        if let Some((name, _)) = columns.iter().find(|(_, values)| !finite(values)) {
            return wrong(format!("column `{name}` has values that are no finite numbers"));
        }
        let (columns, signals) = columns.into_iter().map(|(name, values)| (name, Ok(values))).unzip();
        let table = Table::default();
        Self { file: file.to_owned(), columns, table, time: None, t_s, equal_stamps: 0, signals }.spread()
    }

    pub fn timed(source: impl Read, file: &str, table: &Table, time: &Time) -> Result<Self, CsvError> {
        let too_short = |rows| {
            let what = format!("{rows} rows of samples; a recording has a header line and at least two rows");
            Err(CsvError::File { file: file.to_owned(), what })
        };
        let mut reader = rows(source, table).map_err(|error| CsvError::of(file, error.into()))?;
        let header = reader.headers().map_err(|error| CsvError::of(file, error))?;
        let columns: Vec<String> = match table.header {
            true => header.iter().map(str::to_owned).collect(),
            false => (1..=header.len()).map(|n| format!("column_{n}")).collect(),
        };
        if columns.is_empty() {
            return too_short(0);
        }
        let signals = vec![Ok(Vec::new()); columns.len()];
        let mut recording = Self {
            file: file.to_owned(),
            columns,
            table: *table,
            time: None,
            t_s: Vec::new(),
            equal_stamps: 0,
            signals,
        };
        recording.time = match (&time.rate_hz, &time.column) {
            (Some(_), _) => None,
            (None, Some(name)) if recording.count(name) > 0 => Some(recording.place(name)?),
            (None, Some(name)) => {
                return Err(recording.no_column(&format!("no time column `{name}`, which the recipe names")));
            }
            (None, None) => match TIME_COLUMNS.iter().find(|name| recording.count(name) > 0) {
                Some(name) => Some(recording.place(name)?),
                None => {
                    return Err(recording.no_column(
                        "no time column: one must be called `t` or `t_s` and hold seconds, or a recipe's [time] names \
                         another, or says the rows a second (rate_hz)",
                    ));
                }
            },
        };
        let mut row = StringRecord::new();
        // Of a recording that is too long, only the time is read on: the error says how long it is.
        let mut too_long_s = None;
        while reader.read_record(&mut row).map_err(|error| CsvError::of(&recording.file, error))? {
            let line = row.position().map_or(0, csv::Position::line);
            let t_s = recording.time_s(&row, line, time)?;
            let first_s = *recording.t_s.first().unwrap_or(&t_s);
            if t_s - first_s > LONGEST_S {
                too_long_s = Some(t_s - first_s);
                continue;
            }
            recording.t_s.push(t_s);
            for ((signal, column), cell) in recording.signals.iter_mut().zip(&recording.columns).zip(&row) {
                if let Ok(values) = signal {
                    match table.number(column, cell) {
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
            None => recording.spread(),
        }
    }

    /// Rows that came in bursts with one stamp each, as of a radio that sends them together: the stamp is that of the last, and those
    /// before it lie evenly between it and the stamp before, at most as far apart as in most bursts.
    fn spread(mut self) -> Result<Self, CsvError> {
        let mut bursts: Vec<(f64, usize)> = Vec::new();
        for &t_s in &self.t_s {
            match bursts.last_mut() {
                Some((stamp, rows)) if *stamp == t_s => *rows += 1,
                _ => bursts.push((t_s, 1)),
            }
        }
        self.equal_stamps = self.t_s.len() - bursts.len();
        if self.equal_stamps == 0 {
            return Ok(self);
        }
        let step = |pair: &[(f64, usize)]| (pair[1].0 - pair[0].0) / pair[1].1 as f64;
        let Some(usual_s) = middle(bursts.windows(2).map(step)) else {
            let what = format!(
                "every row has the time {} s; a recipe can say the rows a second: [time] rate_hz",
                self.t_s[0]
            );
            return Err(CsvError::File { file: self.file, what });
        };
        self.t_s.clear();
        let mut before_s = f64::NEG_INFINITY;
        for (stamp, rows) in bursts {
            let step_s = ((stamp - before_s) / rows as f64).min(usual_s);
            self.t_s.extend((0..rows).rev().map(|left| stamp - left as f64 * step_s));
            before_s = stamp;
        }
        Ok(self)
    }

    fn time_s(&self, row: &StringRecord, line: u64, time: &Time) -> Result<f64, CsvError> {
        let wrong = |what| CsvError::Row { file: self.file.clone(), line, what };
        let t_s = match (self.time, &time.rate_hz) {
            (Some(place), _) => {
                self.table.number(&self.columns[place], &row[place]).map_err(wrong)? / time.unit.in_a_second()
            }
            (None, rate) => self.t_s.len() as f64 / rate.as_ref().map_or(1.0, |rate| *rate.get_ref()),
        };
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
        let of_signals = self.columns.iter().enumerate().filter(|&(place, _)| Some(place) != self.time);
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

    /// Rows a second, on average.
    pub fn rate_hz(&self) -> f64 {
        (self.t_s.len() - 1) as f64 / self.duration_s()
    }

    pub fn series(&self, column: &str) -> Result<Vec<f64>, CsvError> {
        let row = |(line, what)| CsvError::Row { file: self.file.clone(), line, what };
        self.signals[self.place(column)?].clone().map_err(row)
    }

    /// What was taken for what, for a person to see whether it is right; `goes_to` names the channels of a column.
    pub fn explained(&self, goes_to: &dyn Fn(&str) -> String) -> String {
        let Table { delimiter, decimal, comment, header } = &self.table;
        let mut text = format!(
            "{}: {} rows of {} columns; delimiter {delimiter:?}, decimal {decimal:?}, comment {comment:?}, header {header}\n\
             time: {}, {} s to {} s, {:.1} rows a second, longest gap {:.1} ms, {} rows with the stamp of the row before{}\n\n\
             {:<24} {:<24} first rows; lowest to highest\n",
            self.file,
            self.t_s.len(),
            self.columns.len(),
            self.time.map_or("by the rate", |place| &self.columns[place]),
            self.first_s(),
            self.span_s().end(),
            self.rate_hz(),
            1e3 * self.longest_gap_s(),
            self.equal_stamps,
            if self.equal_stamps > 0 { ": spread evenly" } else { "" },
            "column",
            "goes to"
        );
        for (column, signal) in self.columns.iter().zip(&self.signals) {
            let values = match signal {
                Ok(values) => {
                    let first: Vec<String> = values.iter().take(3).map(f64::to_string).collect();
                    let (low, high) = values
                        .iter()
                        .fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
                    format!("{}; {low} to {high}", first.join(", "))
                }
                Err((line, what)) => format!("line {line}: {what}"),
            };
            text += &format!("{column:<24} {:<24} {values}\n", goes_to(column));
        }
        text
    }

    /// What a person who believes the stamps has to know.
    pub fn doubts(&self) -> Vec<String> {
        let told = format!(
            "{} rows have the time of the row before, as in bursts: they were spread evenly before each stamp",
            self.equal_stamps
        );
        if self.equal_stamps > 0 { vec![told] } else { Vec::new() }
    }

    fn count(&self, column: &str) -> usize {
        self.columns.iter().filter(|name| *name == column).count()
    }

    /// Fails where none is called so, or several are.
    fn place(&self, column: &str) -> Result<usize, CsvError> {
        match self.columns.iter().position(|name| name == column) {
            Some(_) if self.count(column) > 1 => {
                let what = format!("two columns are called `{column}`");
                Err(CsvError::Row { file: self.file.clone(), line: 1, what })
            }
            Some(place) => Ok(place),
            None => Err(self.no_column(&format!("no column `{column}`"))),
        }
    }

    fn no_column(&self, why: &str) -> CsvError {
        let columns = self.columns.iter().map(String::as_str);
        CsvError::no_column(&self.file, why, columns, &self.table.hint(&self.columns))
    }
}
