//! Reports as text or JSON.

use std::fmt::Display;

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
    /// Prints a report as `text`, or as JSON.
    pub fn print(self, text: &impl Display, report: &impl Serialize) -> anyhow::Result<()> {
        match self {
            Self::Text => out::print(format_args!("{text}")),
            Self::Json => out::say!("{}", serde_json::to_string_pretty(report)?),
        }
    }

    /// Prints a report as keys and values for people, or as JSON.
    pub fn show(self, report: &impl Serialize) -> anyhow::Result<()> {
        let text = match serde_json::to_value(report)? {
            Value::Object(fields) => lines(&fields, 0),
            other => word(&other) + "\n",
        };
        self.print(&text, report)
    }
}

/// Lines of key and value. Neighbours with the same keys are the rows of a table.
fn lines(fields: &Map<String, Value>, indent: usize) -> String {
    let pad = " ".repeat(indent);
    let (nested, plain): (Vec<_>, Vec<_>) = fields.iter().partition(|(_, value)| is_nested(value));
    let mut text: String =
        plain.iter().map(|(key, value)| format!("{pad}{key:<28}{}\n", word(value))).collect();
    for rows in nested.chunk_by(|a, b| columns(a.1).is_some() && columns(a.1) == columns(b.1)) {
        let (key, value) = rows[0];
        text += &match value {
            Value::Object(_) if rows.len() > 1 => {
                table(&rows.iter().map(|(key, row)| (key.as_str(), *row)).collect::<Vec<_>>(), indent)
            }
            Value::Object(fields) => format!("{pad}{key}\n{}", lines(fields, indent + 2)),
            Value::Array(list) if list.iter().all(|row| columns(row).is_some()) => {
                let tables = list
                    .chunk_by(|a, b| columns(a) == columns(b))
                    .map(|rows| table(&rows.iter().map(|row| ("", row)).collect::<Vec<_>>(), indent));
                format!("{pad}{key}\n{}", tables.collect::<String>())
            }
            Value::Array(list) => {
                let entry = |(n, entry): (u32, &Value)| match entry {
                    Value::Object(fields) => format!("{pad}{key} {n}\n{}", lines(fields, indent + 2)),
                    other => format!("{pad}{key} {n}\n{pad}  {}\n", word(other)),
                };
                (1..).zip(list).map(entry).collect()
            }
            _ => String::new(),
        };
    }
    text
}

/// Whether it takes lines of its own.
fn is_nested(value: &Value) -> bool {
    match value {
        Value::Object(_) => true,
        Value::Array(list) => list.iter().any(|value| value.is_object() || value.is_array()),
        _ => false,
    }
}

/// The keys of an entry without nested ones.
fn columns(value: &Value) -> Option<Vec<&String>> {
    let fields = value.as_object()?;
    (!fields.is_empty() && !fields.values().any(is_nested)).then(|| fields.keys().collect())
}

fn table(rows: &[(&str, &Value)], indent: usize) -> String {
    let keys = rows.first().and_then(|(_, row)| columns(row)).unwrap_or_default();
    let cells = |row: &Value| keys.iter().map(|key| word(&row[key.as_str()])).collect::<Vec<_>>();
    let mut all = vec![("", keys.iter().map(ToString::to_string).collect())];
    all.extend(rows.iter().map(|(name, row)| (*name, cells(row))));
    let name = all.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let width = |n: usize| all.iter().map(|(_, cells)| cells[n].len()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..keys.len()).map(width).collect();
    let line = |(own, cells): &(&str, Vec<String>)| {
        let cells: String =
            cells.iter().zip(&widths).map(|(cell, width)| format!("  {cell:>width$}")).collect();
        format!("{:indent$}{own:<name$}{cells}\n", "")
    };
    all.iter().map(line).collect()
}

/// Four digits of a number, `-` where there is none.
fn word(value: &Value) -> String {
    match value {
        Value::Null => "-".to_owned(),
        Value::String(text) if text.contains('\n') => format!("{} lines", text.lines().count()),
        Value::String(text) => text.clone(),
        Value::Array(list) if list.is_empty() => "none".to_owned(),
        Value::Array(list) => list.iter().map(word).collect::<Vec<_>>().join(", "),
        Value::Number(number) if number.is_f64() => match number.as_f64().unwrap_or(f64::NAN) {
            0.0 => "0".to_owned(),
            exact => {
                let places = (3.0 - exact.abs().max(1e-3).log10().floor()).clamp(0.0, 6.0) as usize;
                format!("{exact:.places$}")
            }
        },
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
        assert_eq!(lines(report.as_object().unwrap(), 0), expected);
    }
}
