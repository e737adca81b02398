//! How a report is printed.

use std::fmt::{self, Display};

use clap::ValueEnum;
use serde::Serialize;
use serde_json::{Map, Value};

use super::out;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For people
    Text,
    /// For programs
    Json,
}

impl Format {
    /// Prints a report on stdout: as `text`, or as the keys and numbers of `report`.
    /// Fails if the report cannot be written as JSON, or not printed.
    pub fn print(self, text: &impl Display, report: &impl Serialize) -> anyhow::Result<()> {
        match self {
            Self::Text => out::print(format_args!("{text}")),
            Self::Json => out::say!("{}", serde_json::to_string_pretty(report)?),
        }
    }

    /// Prints a report of which people read the keys and numbers, too. Fails as [`print`](Self::print) does.
    pub fn show(self, report: &impl Serialize) -> anyhow::Result<()> {
        self.print(&Plain(&serde_json::to_value(report)?), report)
    }
}

/// A report as lines of key and value; entries with the same keys are the rows of a table.
struct Plain<'a>(&'a Value);

impl Display for Plain<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Value::Object(fields) => lines(f, fields, 0),
            other => writeln!(f, "{}", word(other)),
        }
    }
}

fn lines(f: &mut fmt::Formatter<'_>, fields: &Map<String, Value>, indent: usize) -> fmt::Result {
    let (nested, plain): (Vec<_>, Vec<_>) = fields.iter().partition(|(_, value)| is_nested(value));
    for (key, value) in plain {
        writeln!(f, "{:indent$}{key:<28}{}", "", word(value))?;
    }
    // What stands side by side and has the same keys is one table.
    for rows in nested.chunk_by(|a, b| columns(a.1).is_some() && columns(a.1) == columns(b.1)) {
        let [(key, value), others @ ..] = rows else { continue };
        match value {
            Value::Object(_) if columns(value).is_some() && !others.is_empty() => {
                table(f, &rows.iter().map(|(key, row)| (key.as_str(), *row)).collect::<Vec<_>>(), indent)?;
            }
            Value::Object(fields) => {
                writeln!(f, "{:indent$}{key}", "")?;
                lines(f, fields, indent + 2)?;
            }
            Value::Array(list) if list.iter().all(|row| columns(row).is_some()) => {
                writeln!(f, "{:indent$}{key}", "")?;
                for rows in list.chunk_by(|a, b| columns(a) == columns(b)) {
                    table(f, &rows.iter().map(|row| ("", row)).collect::<Vec<_>>(), indent)?;
                }
            }
            Value::Array(list) => {
                for (n, entry) in list.iter().enumerate() {
                    writeln!(f, "{:indent$}{key} {}", "", n + 1)?;
                    match entry {
                        Value::Object(fields) => lines(f, fields, indent + 2)?,
                        other => writeln!(f, "{:indent$}  {}", "", word(other))?,
                    }
                }
            }
            _ => {}
        }
    }
    Ok(())
}

/// Whether it takes lines of its own.
fn is_nested(value: &Value) -> bool {
    match value {
        Value::Object(_) => true,
        Value::Array(list) => list.iter().any(|value| value.is_object() || value.is_array()),
        _ => false,
    }
}

/// The keys of an entry that nothing is nested in.
fn columns(value: &Value) -> Option<Vec<&String>> {
    let fields = value.as_object()?;
    (!fields.is_empty() && !fields.values().any(is_nested)).then(|| fields.keys().collect())
}

fn table(f: &mut fmt::Formatter<'_>, rows: &[(&str, &Value)], indent: usize) -> fmt::Result {
    let Some(columns) = rows.first().and_then(|(_, row)| columns(row)) else { return Ok(()) };
    let name = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let cells = |row: &Value| columns.iter().map(|key| word(&row[key.as_str()])).collect::<Vec<_>>();
    let cells: Vec<Vec<String>> = rows.iter().map(|(_, row)| cells(row)).collect();
    let width = |n: usize| cells.iter().map(|row| row[n].len()).chain([columns[n].len()]).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns.len()).map(width).collect();
    let mut line = |name_of: &str, words: &mut dyn Iterator<Item = &String>| {
        write!(f, "{:indent$}{name_of:<name$}", "")?;
        words.zip(&widths).try_for_each(|(word, width)| write!(f, "  {word:>width$}"))?;
        writeln!(f)
    };
    line("", &mut columns.iter().copied())?;
    rows.iter().zip(&cells).try_for_each(|((name, _), cells)| line(name, &mut cells.iter()))
}

/// Four digits of a number, `-` where there is none.
fn word(value: &Value) -> String {
    match value {
        Value::Null => "-".to_owned(),
        Value::String(text) if text.contains('\n') => format!("{} lines", text.lines().count()),
        Value::String(text) => text.clone(),
        Value::Array(list) if list.is_empty() => "none".to_owned(),
        Value::Array(list) => list.iter().map(word).collect::<Vec<_>>().join(", "),
        Value::Number(number) if number.is_f64() => {
            let exact = number.as_f64().unwrap_or(f64::NAN);
            if exact == 0.0 {
                return "0".to_owned();
            }
            let places = (3.0 - exact.abs().max(1e-3).log10().floor()).clamp(0.0, 6.0) as usize;
            format!("{exact:.places$}")
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_report_is_lines_of_keys_and_tables_of_what_has_the_same_keys() {
        let report = json!({
            "seed": 1, "angle_deg": 0.33333, "none": null, "of": [1, 2],
            "first": { "right": 0.95, "missed": 3 }, "second": { "right": 12.0, "missed": 10 },
            "slip": { "recall": 1234.5 },
            "persons": [{ "person": 1, "ok": true }, { "person": 22, "ok": false }],
            "stories": [{ "name": "a", "parts": [{ "n": 1 }] }],
        });
        let expected = "\
seed                        1
angle_deg                   0.3333
none                        -
of                          1, 2
         right  missed
first   0.9500       3
second   12.00      10
slip
  recall                      1234
persons
  person     ok
       1   true
      22  false
stories 1
  name                        a
  parts
    n
    1
";
        let shown = Plain(&report).to_string();
        assert_eq!(
            shown.lines().map(str::trim_end).collect::<Vec<_>>(),
            expected.lines().collect::<Vec<_>>()
        );
    }
}
