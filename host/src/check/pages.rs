//! The figures of the pages are those that are printed today: docs/figures.toml says by what.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use anyhow::Context;
use serde::Deserialize;

use super::Bar;

/// The tables that are compared, each by the page and the head of its columns.
const TABLES: [(&str, &str); 2] =
    [("docs/results.md", "| promise | measured |"), ("README.md", "| quantity | measured |")];
/// In README, what stands above the report of the default scene.
const PRINTS: &str = "Then it prints:";
/// Of the other commands, one that takes less than a second.
const QUICK: &str = "evaluate emg ";

#[derive(Deserialize)]
struct Figures {
    row: Vec<Row>,
}

/// Where the numbers of a row come from.
#[derive(Deserialize)]
struct Row {
    page: String,
    /// How the row begins.
    row: String,
    /// Parts of the lines that `check` prints.
    #[serde(default)]
    lines: Vec<String>,
    /// Numbers that nothing measures.
    #[serde(default)]
    stated: Vec<String>,
    /// Numbers of other commands.
    #[serde(default)]
    others: BTreeMap<String, Vec<String>>,
}

/// Compares the pages with what `check` printed, the default scene's report among it. Of the other commands those that
/// take minutes are run if `slow`.
/// Fails if a page, the list or a command cannot be read.
pub fn bars(root: &Path, printed: &str, slow: bool) -> anyhow::Result<Vec<Bar>> {
    let read =
        |file: &str| std::fs::read_to_string(root.join(file)).with_context(|| format!("cannot read {file}"));
    let figures: Figures = toml::from_str(&read("docs/figures.toml")?)?;
    let mut wrong = stale(&read("README.md")?, printed);
    for (page, head) in TABLES {
        let text = read(page)?;
        for line in
            text.split(head).nth(1).unwrap_or_default().lines().skip(2).take_while(|line| !line.is_empty())
        {
            let row = figures.row.iter().find(|row| row.page == page && line[2..].starts_with(&row.row));
            wrong.extend(
                unprinted(line, row, printed)
                    .into_iter()
                    .map(|number| format!("{page}: {number} in `{line}`")),
            );
        }
    }
    let promise = "README's report and both tables of results tell what was printed now";
    let is_skipped = printed.lines().any(|line| line.starts_with("skipped"));
    let mut bars =
        vec![if is_skipped { Bar::skipped(promise, "not all was measured") } else { bar(promise, &wrong) }];
    let mut of_others: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (command, numbers) in figures.row.iter().flat_map(|row| &row.others) {
        of_others.entry(command).or_default().extend(numbers.iter().map(String::as_str));
    }
    for (command, all) in of_others.into_iter().filter(|(command, _)| slow || command.starts_with(QUICK)) {
        let promise = format!("{} figures of the pages are those of `tenax {command}`", all.len());
        let output =
            Command::new(std::env::current_exe()?).args(command.split(' ')).current_dir(root).output()?;
        let text = String::from_utf8_lossy(&output.stdout);
        let wrong: Vec<_> =
            all.into_iter().filter(|number| !is_in(number, &text)).map(str::to_owned).collect();
        bars.push(if output.status.success() {
            bar(&promise, &wrong)
        } else {
            Bar::skipped(promise, String::from_utf8_lossy(&output.stderr).trim())
        });
    }
    Ok(bars)
}

fn bar(promise: &str, wrong: &[String]) -> Bar {
    Bar::new(
        promise,
        if wrong.is_empty() { "all".to_owned() } else { format!("not {}", wrong.join("; ")) },
        wrong.is_empty(),
    )
}

/// Lines of README's report that were not printed.
fn stale(readme: &str, printed: &str) -> Vec<String> {
    let block = readme.split(PRINTS).nth(1).unwrap_or_default().trim_start().lines();
    let lines: Vec<&str> = block.map(str::trim).take_while(|line| !line.is_empty()).collect();
    let is_printed = |line: &str| printed.lines().any(|own| own.trim() == line);
    let mut stale: Vec<String> =
        lines.iter().filter(|line| !is_printed(line)).map(|line| format!("`{line}`")).collect();
    if lines.is_empty() {
        stale.push("any report".to_owned());
    }
    stale
}

/// Numbers of a row that nobody answers for.
fn unprinted(line: &str, row: Option<&Row>, printed: &str) -> Vec<String> {
    let Some(row) = row else { return vec!["any figure".to_owned()] };
    let cell = line.split(" | ").nth(1).unwrap_or_default();
    // Of a link its words alone.
    let cell: String = cell
        .split("](")
        .enumerate()
        .map(|(n, part)| if n == 0 { part } else { part.split_once(')').map_or("", |rest| rest.1) })
        .collect();
    let lines: Vec<&str> =
        printed.lines().filter(|line| row.lines.iter().any(|part| line.contains(part.as_str()))).collect();
    let known = row.others.values().flatten().chain(&row.stated);
    let text = known.map(String::as_str).chain(lines).collect::<Vec<_>>().join("\n");
    numbers(&cell).into_iter().filter(|number| !is_in(number, &text)).collect()
}

/// Whether a text has this number, rounded as it is.
fn is_in(number: &str, text: &str) -> bool {
    let number = number.replace(' ', "");
    let half = 0.5 * 0.1_f64.powi(number.split_once('.').map_or(0, |parts| parts.1.len() as i32));
    let Ok(value) = number.parse::<f64>() else { return false };
    numbers(text)
        .iter()
        .filter_map(|other| other.replace(' ', "").parse::<f64>().ok())
        .any(|other| (other - value).abs() <= half * 1.000_001)
}

/// The numbers of a text: `119 999` and `1,000,000` are one each, the digits of `S2` and `F411` none.
fn numbers(text: &str) -> Vec<String> {
    let text: Vec<char> = text.chars().collect();
    let is_digit = |at: usize| text.get(at).is_some_and(char::is_ascii_digit);
    let thousand = |at: usize| (1..4).all(|n| is_digit(at + n)) && !is_digit(at + 4);
    let (mut found, mut at) = (Vec::new(), 0);
    while at < text.len() {
        let begins =
            is_digit(at) && !(at > 0 && (text[at - 1].is_alphanumeric() || "_-".contains(text[at - 1])));
        if !begins {
            at += 1;
            continue;
        }
        let mut number = String::new();
        while is_digit(at)
            || matches!(text.get(at), Some('.')) && is_digit(at + 1)
            || matches!(text.get(at), Some(' ' | ',')) && thousand(at)
        {
            number.extend(Some(text[at]).filter(|sign| *sign != ','));
            at += 1;
        }
        found.push(number);
        while text.get(at).is_some_and(|sign| sign.is_alphanumeric()) {
            at += 1;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row() -> Row {
        toml::from_str(
            "page = \"\"\nrow = \"a\"\nlines = [\"speed\"]\nstated = [\"4\"]\nothers = { run = [\"7\"] }",
        )
        .unwrap()
    }

    #[test]
    fn a_number_is_held_against_the_lines_of_its_row_as_the_page_rounds_it() {
        let printed = "speed 5.249 mm of 119999\nforce 8.1 N";
        let held = |cell: &str| unprinted(&format!("| a | {cell} |"), Some(&row()), printed);
        assert!(held("5.2 mm of 119 999, S1 of 4 [7](8.md)").is_empty());
        assert_eq!(held("5.3 mm, 8.1 N, 5.24"), ["5.3", "8.1", "5.24"]);
        assert_eq!(unprinted("| b | 1 |", None, printed), ["any figure"]);
    }

    #[test]
    fn a_line_of_the_readme_that_is_not_printed_is_found() {
        let readme = "Then it prints:\n\n    object  kept\n    grip  16.31 N\n\nMore.";
        assert!(stale(readme, "x\nobject  kept\n  grip  16.31 N\n").is_empty());
        assert_eq!(stale(readme, "object  kept\ngrip  16.32 N"), ["`grip  16.31 N`"]);
        assert_eq!(stale("no report", "object"), ["any report"]);
    }

    #[test]
    fn numbers_are_whole() {
        assert_eq!(
            numbers("1,000,000 of 1 000 000, S2 at 0.5 ms, 18%, F411RE, 2.5-3, 0.84 to 0.97."),
            ["1000000", "1 000 000", "0.5", "18", "2.5", "0.84", "0.97"]
        );
    }
}
