//! Reports as text or JSON.

use std::fmt::Display;

use clap::ValueEnum;
use serde::Serialize;
use serde_json::Value;

use super::out;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For people
    Text,
    /// For programs
    Json,
}

impl Format {
    pub fn print(self, text: &impl Display, report: &impl Serialize) -> anyhow::Result<()> {
        match self {
            Self::Text => out::print(format_args!("{text}")),
            Self::Json => out::say!("{}", serde_json::to_string_pretty(report)?),
        }
    }

    /// Prints a report as keys and values for people, or as JSON.
    pub fn show(self, report: &impl Serialize) -> anyhow::Result<()> {
        self.print(&lines(&serde_json::to_value(report)?, 0), report)
    }
}

/// Lines of key and value, indented below the key that they belong to.
fn lines(value: &Value, indent: usize) -> String {
    let Some(children) = children(value) else { return word(value) + "\n" };
    let line = |(key, value): (String, &Value)| {
        let is_row = self::children(value).is_none_or(|all| all.iter().all(|(_, value)| is_plain(value)));
        match is_row {
            true => format!("{:indent$}{key:<28}{}\n", "", word(value)),
            false => format!("{:indent$}{key}\n{}", "", lines(value, indent + 2)),
        }
    };
    children.into_iter().map(line).collect()
}

/// Fields by name, or entries of a list by number from 1.
fn children(value: &Value) -> Option<Vec<(String, &Value)>> {
    match value {
        Value::Object(fields) => Some(fields.iter().map(|(key, value)| (key.clone(), value)).collect()),
        Value::Array(list) => Some((1..).map(|n: u32| n.to_string()).zip(list).collect()),
        _ => None,
    }
}

const fn is_plain(value: &Value) -> bool {
    !matches!(value, Value::Object(_) | Value::Array(_))
}

/// Four digits of a number, `-` where there is none.
fn word(value: &Value) -> String {
    match value {
        Value::Null => "-".to_owned(),
        Value::String(text) if text.contains('\n') => format!("{} lines", text.lines().count()),
        Value::String(text) => text.clone(),
        Value::Array(list) if list.is_empty() => "none".to_owned(),
        Value::Array(list) => list.iter().map(word).collect::<Vec<_>>().join(", "),
        Value::Object(fields) => {
            fields.iter().map(|(key, value)| format!("{key} {}", word(value))).collect::<Vec<_>>().join(", ")
        }
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
    use super::*;

    #[test]
    fn a_report_is_a_line_a_key_and_a_row_an_entry() {
        let report = serde_json::json!({
            "angle_deg": 0.33333, "of": [1, null], "first": { "right": 0.95 }, "stories": [{ "parts": [{ "n": 1 }] }],
        });
        let expected = [
            "angle_deg                   0.3333\nof                          1, -\n",
            "first                       right 0.9500\n",
            "stories\n  1\n    parts\n      1                           n 1\n",
        ];
        assert_eq!(lines(&report, 0), expected.concat());
    }
}
