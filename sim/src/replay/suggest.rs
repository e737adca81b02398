//! A recipe to begin with, from how a table looks: its signs, its time, and a map for each column that holds numbers.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use anyhow::Context;
use tenax_hal_shim::channel;

use super::Recording;
use super::recipe::Time;
use crate::input::Table;

/// Lines that are looked at.
const LINES: usize = 50;

/// The recipe's text, for a person to complete. Fails if the file cannot be read, or no signs make a table of it.
pub fn suggest(path: &Path) -> anyhow::Result<String> {
    let name = path.display().to_string();
    let file = BufReader::new(File::open(path).with_context(|| format!("{name}: cannot be read"))?);
    let lines = file.lines().map_while(Result::ok).take(LINES);
    let lines: Vec<String> = lines.map(|line| line.trim_start_matches('\u{feff}').to_owned()).collect();
    let table = table(&lines);
    let Table { delimiter, decimal, header, .. } = table;
    let recording = Recording::read(path, &table, &Time::of_rate(1_000.0))?;
    let columns: Vec<(&str, Vec<f64>)> =
        recording.signals().filter_map(|column| Some((column, recording.series(column).ok()?))).collect();
    let mut text = format!(
        "title = {name:?}\ndescription = \"\"\n\n[table]\ndelimiter = {:?}\ndecimal = {:?}\nheader = {header}\n\n[time]\n",
        delimiter.to_string(),
        decimal.to_string()
    );
    let time = columns.iter().find(|(column, values)| is_time(column) && values.is_sorted());
    text += &match time {
        Some((column, values)) => format!("column = {column:?}\nunit = {:?}\n", unit(values)),
        None => "rate_hz = 1000        # rows a second: say the right number\n".to_owned(),
    };
    for (column, values) in columns.iter().filter(|(column, _)| time.is_none_or(|(time, _)| time != column)) {
        let (low, high) =
            values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
        let own = channel::by_name(column).map(|_| column);
        // What goes nowhere yet is a comment.
        let mark = if own.is_some() { "" } else { "# " };
        text += &format!(
            "\n# {low} to {high}\n{mark}[[map]]\n{mark}column = {column:?}\n{mark}channels = [{:?}]\n{mark}gain = 1.0            \
             # volts at the pin for one unit\n",
            own.unwrap_or(&"myo_flexor")
        );
    }
    Ok(text)
}

/// The signs that make most of the first lines.
fn table(lines: &[String]) -> Table {
    let mut rows: Vec<&str> =
        lines.iter().map(String::as_str).skip_while(|line| line.starts_with(['%', '#'])).collect();
    // ROS begins its header so.
    if let Some(before) = lines.len().checked_sub(rows.len() + 1)
        && rows.first().is_some_and(|row| row.matches(',').count() == lines[before].matches(',').count())
        && lines[before].contains(',')
    {
        rows.insert(0, &lines[before]);
    }
    let cells = |sign: char| rows.first().map_or(0, |row| row.matches(sign).count());
    let is_even = |sign: &char| rows.iter().all(|row| row.matches(*sign).count() == cells(*sign));
    let delimiter =
        [';', '\t', ','].into_iter().find(|sign| cells(*sign) > 0 && is_even(sign)).unwrap_or(',');
    let body = rows.iter().skip(1).flat_map(|row| row.split(delimiter));
    let is_comma =
        |cell: &str| !cell.contains('.') && cell.trim().replacen(',', ".", 1).parse::<f64>().is_ok();
    let decimal = if delimiter != ',' && body.clone().any(|cell| cell.contains(',') && is_comma(cell)) {
        ','
    } else {
        '.'
    };
    let table = Table { delimiter, decimal, ..Table::default() };
    let header = rows
        .first()
        .is_none_or(|row| row.split(delimiter).any(|cell| table.number("", cell.trim()).is_err()));
    Table { header, ..table }
}

fn is_time(column: &str) -> bool {
    let column = column.to_lowercase();
    ["t", "t_s"].contains(&&*column) || column.contains("time") || column.contains("stamp")
}

/// By the size of times since 1970, else by the step: no sensor is read less than twice a second.
fn unit(values: &[f64]) -> &'static str {
    let last = values.last().copied().unwrap_or_default();
    let step = (last - values[0]) / (values.len() - 1) as f64;
    match () {
        () if last > 1e17 || step > 5e5 => "ns",
        () if last > 1e14 || step > 5e2 => "us",
        () if last > 1e11 || step > 0.5 => "ms",
        () => "s",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::replay::Recipe;

    #[test]
    fn what_is_suggested_reads_the_table() {
        let rows = |of: &dyn Fn(u32) -> String| (0..60).map(of).collect::<String>();
        let ros = "%time,field.effort0\n".to_owned()
            + &rows(&|n| format!("{},0.{n}\n", 1_400_000_000_000_000_000_u64 + 5_000_000 * u64::from(n)));
        let open_bci =
            "\u{feff}%OpenBCI, Raw\n%Rate = 200 Hz\nIndex, EXG, Other, Other, Timestamp, Timestamp (Formatted)\n"
                .to_owned()
                + &rows(&|n| format!("{n}, -4.{n}, 0, 0, {}, 2023-01-01\n", 1.6e9 + f64::from(n) / 200.0));
        for (csv, says, first_s, rate_hz) in [
            (
                rows(&|n| format!("-0,0387;1,6{n}\n")),
                "header = false\n\n[time]\nrate_hz = 1000 ",
                0.0,
                1_000.0,
            ),
            ("t;pvdf_1\n".to_owned() + &rows(&|n| format!("0,{n:02};1,65\n")), "decimal = \",\"", 0.0, 100.0),
            (
                "when_timestamp\ta\n".to_owned() + &rows(&|n| format!("{}\t7\n", 10 * n)),
                "unit = \"ms\"",
                0.0,
                100.0,
            ),
            (ros, "column = \"%time\"\nunit = \"ns\"", 1.4e9, 200.0),
            (open_bci, "column = \"Timestamp\"\nunit = \"s\"", 1.6e9, 200.0),
        ] {
            let file = tempfile::NamedTempFile::new().unwrap();
            std::fs::write(file.path(), &csv).unwrap();
            let text = suggest(file.path()).unwrap();
            assert!(text.contains(says), "{says}: {text}");
            // As a person completes it.
            let text = text + "[[map]]\ncolumn = 'x'\nchannels = ['array_1']\ngain = 1.0\n";
            let recipe = Recipe::parse(&text, "r.toml").unwrap();
            let read = Recording::read(file.path(), &recipe.table(), &recipe.time).unwrap();
            assert!(
                (read.first_s() - first_s).abs() < 1e-6 && (read.rate_hz() / rate_hz - 1.0).abs() < 1e-3,
                "{csv}"
            );
        }
    }
}
