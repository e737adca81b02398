//! The figures of the pages are those that are printed today: docs/figures.toml says by what.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::Context;
use serde::Deserialize;

use super::Bar;
use crate::suite;

/// Pages that a command or a trainer writes: other tests hold them, or nobody edits them.
const WRITTEN: [&str; 5] =
    ["docs/bibliography.md", "docs/commands.md", "docs/safety/soup.md", "docs/settings.md", "docs/wiring.md"];
/// In README, what stands above the report of the default scene.
const PRINTS: &str = "Then it prints:";
/// Of the other commands, one that takes seconds.
const QUICK: &str = "evaluate emg --recordings ../shared/data/myobock";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Figures {
    row: Vec<Row>,
}

/// Where the numbers of some lines of a page come from; docs/figures.toml says more.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    page: String,
    /// A part of these lines, or the heading that they stand under; empty: the whole page.
    row: String,
    /// The commands that print them.
    #[serde(default)]
    of: Vec<String>,
    /// Parts of the lines in which they are printed: by `check` itself, if by no other command.
    #[serde(default)]
    lines: Vec<String>,
    /// Files in which each stands, in this unit or in one of its tens.
    #[serde(default)]
    source: Vec<String>,
    /// Numbers that nothing measures.
    #[serde(default)]
    stated: Vec<String>,
    /// Why nothing measures any of them.
    #[serde(default)]
    stated_by: String,
    /// Numbers that nothing prints any more, by how they were measured and why they stay.
    #[serde(default)]
    measured_once: BTreeMap<String, Vec<String>>,
}

/// A line of a page with its numbers.
struct Line {
    page: String,
    heading: String,
    text: String,
    numbers: Vec<String>,
}

/// What each command printed; [`CHECK`] is `check` itself.
type Printed<'a> = BTreeMap<&'a str, String>;
const CHECK: &str = "";

impl Row {
    fn is_of(&self, line: &Line) -> bool {
        self.page == line.page && (self.row == line.heading || line.text.contains(&self.row))
    }

    /// The numbers that it names.
    fn named(&self) -> impl Iterator<Item = &String> {
        self.measured_once.values().flatten().chain(&self.stated)
    }

    /// Whether it answers for a number. `sources` are the numbers of its files; a command that was not run is believed.
    fn answers_for(&self, number: &str, sources: &BTreeSet<String>, printed: &Printed<'_>) -> bool {
        let is_printed = |command: &str| {
            let Some(text) = printed.get(command) else { return true };
            let has = |line: &&str| {
                self.lines.is_empty() || self.lines.iter().any(|part| line.contains(part.as_str()))
            };
            is_in(number, &text.lines().filter(has).collect::<Vec<_>>().join("\n"))
        };
        !self.stated_by.is_empty()
            || self.named().any(|own| own == number)
            || sources.contains(&digits(number))
            || self.of.iter().any(|command| is_printed(command))
            || self.of.is_empty() && !self.lines.is_empty() && is_printed(CHECK)
    }
}

fn read(root: &Path, file: &str) -> anyhow::Result<String> {
    fs::read_to_string(root.join(file)).with_context(|| format!("cannot read {file}"))
}

/// Compares the pages with what `check` printed, the default scene's report among it. Of the other commands those that
/// take minutes are run if `slow`.
/// Fails if a page, the list or a command cannot be read.
pub fn bars(root: &Path, own: &str, slow: bool) -> anyhow::Result<Vec<Bar>> {
    let figures: Figures = toml::from_str(&read(root, "docs/figures.toml")?)?;
    let (mut bars, mut wrong, mut printed) = (Vec::new(), Vec::new(), Printed::new());
    if own.lines().any(|line| line.starts_with("skipped")) {
        bars.push(Bar::skipped(
            "README's report and the results are those of `check`",
            "not all was measured",
        ));
    } else {
        wrong.extend(stale(&read(root, "README.md")?, own));
        printed.insert(CHECK, own.to_owned());
    }
    let commands: BTreeSet<&String> = figures.row.iter().flat_map(|row| &row.of).collect();
    for command in commands.into_iter().filter(|command| slow || *command == QUICK) {
        let mut run = match command.strip_prefix("test ") {
            Some(_) => suite::all(),
            None => Command::new(std::env::current_exe()?),
        };
        for word in command.trim_start_matches("test ").split(' ') {
            match word.split_once('=') {
                Some((name, value)) => run.env(name, value),
                None => run.arg(word),
            };
        }
        let output = run.current_dir(root).output()?;
        let [text, said] =
            [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
        // A test without its recordings is ignored.
        if output.status.success() && !text.contains("... ignored, ") {
            printed.insert(command, text);
        } else {
            let why = said.trim().lines().last().unwrap_or("not measured here");
            bars.push(Bar::skipped(format!("figures of the pages are those of `{command}`"), why));
        }
    }
    let commands: Vec<&str> = printed.keys().map(|command| command.trim_end()).collect();
    let promise =
        format!("README's report and the figures of the pages are those of `check` {}", commands.join(", "));
    wrong.extend(wrong_in(root, &figures, &printed)?);
    let figure = if wrong.is_empty() { "all".to_owned() } else { format!("not {}", wrong.join("; ")) };
    bars.push(Bar::new(promise, figure, wrong.is_empty()));
    Ok(bars)
}

/// Numbers of the pages that docs/figures.toml does not answer for, and rows and numbers of it that are on no page. No
/// command is run. Fails if a page, the list or a source cannot be read.
pub fn unanswered(root: &Path) -> anyhow::Result<Vec<String>> {
    wrong_in(root, &toml::from_str(&read(root, "docs/figures.toml")?)?, &Printed::new())
}

fn wrong_in(root: &Path, figures: &Figures, printed: &Printed<'_>) -> anyhow::Result<Vec<String>> {
    let mut lines = lines_of("README.md", &read(root, "README.md")?);
    for folder in ["docs", "docs/safety"] {
        for entry in fs::read_dir(root.join(folder))? {
            let page = format!("{folder}/{}", entry?.file_name().to_string_lossy());
            if page.ends_with(".md") && !WRITTEN.contains(&page.as_str()) {
                lines.extend(lines_of(&page, &read(root, &page)?));
            }
        }
    }
    let mut wrong = Vec::new();
    let mut left: Vec<Vec<&String>> = lines.iter().map(|line| line.numbers.iter().collect()).collect();
    for row in &figures.row {
        let mut sources = BTreeSet::new();
        for file in &row.source {
            let text = read(root, file)?.replace('_', "").replace('-', " ");
            sources.extend(numbers(&text).iter().map(|number| digits(number)));
        }
        let mut seen = BTreeSet::new();
        for (line, left) in lines.iter().zip(&mut left).filter(|(line, _)| row.is_of(line)) {
            seen.extend(&line.numbers);
            left.retain(|number| !row.answers_for(number, &sources, printed));
        }
        let gone = row.named().filter(|number| !seen.contains(number)).map(String::as_str);
        let gone = gone.chain(seen.is_empty().then_some("figure"));
        wrong.extend(gone.map(|what| format!("{}: no {what} in `{}`", row.page, row.row)));
    }
    for (line, left) in lines.iter().zip(left) {
        wrong.extend(left.into_iter().map(|number| format!("{}: {number} in `{}`", line.page, line.text)));
    }
    Ok(wrong)
}

/// The lines of a page that have numbers: no code, headings, or tables made from types. Of a link its words alone.
fn lines_of(page: &str, text: &str) -> Vec<Line> {
    let (mut found, mut heading, mut is_skipped) = (Vec::new(), "", false);
    for line in text.lines() {
        is_skipped ^= line.starts_with("```") || line.starts_with("<!-- from") || line == "<!-- end -->";
        if line.starts_with('#') && !is_skipped {
            heading = line;
        }
        if is_skipped || line.starts_with("    ") || line.starts_with('#') {
            continue;
        }
        let words: String = line.split('`').step_by(2).collect();
        let words: String = words
            .split("](")
            .enumerate()
            .map(|(n, part)| if n == 0 { part } else { part.split_once(')').map_or("", |rest| rest.1) })
            .collect();
        let numbers = numbers(&words);
        if !numbers.is_empty() {
            let [page, heading, text] = [page, heading, line].map(str::to_owned);
            found.push(Line { page, heading, text, numbers });
        }
    }
    found
}

/// What is left of a number in every unit: `0.50` s is `500` ms.
fn digits(number: &str) -> String {
    number.replace(['.', ' '], "").trim_matches('0').to_owned()
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

/// Whether a text has this number, rounded as it is; a part of 1 may be per cent on the page.
fn is_in(number: &str, text: &str) -> bool {
    let number = number.replace(' ', "");
    let Ok(value) = number.parse::<f64>() else { return false };
    let decimals = number.split_once('.').map_or(0, |parts| parts.1.len() as i32);
    // Thousands that end in hundreds are rounded to them: an image's mean differs by one from one checkout's folder to another's.
    let step = if value >= 1e3 && value % 100.0 == 0.0 { 100.0 } else { 0.1_f64.powi(decimals) };
    let half = 0.5 * step;
    let is_near = |other: f64| (other - value).abs() <= half * 1.000_001;
    numbers(&text.replace('-', " "))
        .iter()
        .filter_map(|other| other.replace(' ', "").parse::<f64>().ok())
        .any(|other| is_near(other) || other < 1.0 && is_near(100.0 * other))
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

    /// Numbers of a page without an answer of the row; a source has `35`.
    fn left(text: &str, row: &str, printed: &Printed<'_>) -> Vec<String> {
        let row: Row = toml::from_str(&format!("page = \"p\"\n{row}")).unwrap();
        let sources = BTreeSet::from(["35".to_owned()]);
        let lines = lines_of("p", text);
        let left = |line: &Line| {
            let is_left = |number: &&String| !row.is_of(line) || !row.answers_for(number, &sources, printed);
            line.numbers.iter().filter(is_left).cloned().collect::<Vec<_>>()
        };
        lines.iter().flat_map(left).collect()
    }

    #[test]
    fn a_number_is_held_against_the_lines_of_its_row_as_the_page_rounds_it() {
        let row = "row = \"| a\"\nlines = [\"speed\"]\nstated = [\"4\"]";
        let text = "speed 5.249 mm of 119999\nforce 8.1 N".to_owned();
        let printed = Printed::from([(CHECK, text.clone())]);
        let of = |cell: &str, printed| left(&format!("| a | {cell} |"), row, printed);
        assert!(of("5.2 mm of 119 999, S1 of 4 [x7](8.md), `6`", &printed).is_empty());
        assert_eq!(of("5.3 mm, 8.1 N, 5.24", &printed), ["5.3", "8.1", "5.24"]);
        assert!(
            is_in("3800", "3801") && !is_in("3801", "3802") && !is_in("3800", "3851") && !is_in("100", "101")
        );
        assert!(is_in("2.5", "0.02536") && is_in("0.97", "0.84-0.97") && !is_in("253.6", "2.536"));
        assert!(of("5.3 mm", &Printed::new()).is_empty());
        assert_eq!(left("| b | 1 |", row, &printed), ["1"]);
        let other = "row = \"| a\"\nof = [\"x\"]\nlines = [\"speed\"]";
        assert!(left("| a | 9 |", other, &printed).is_empty());
        assert_eq!(left("| a | 5.2, 8.1 |", other, &Printed::from([("x", text)])), ["8.1"]);
    }

    #[test]
    fn a_new_number_of_a_page_has_no_answer() {
        let row = "row = \"## A\"\nstated = [\"4\"]";
        let page = "# 1\n```\n2\n```\n    3\n## A\nafter 4 s and 0.35 s\n";
        let left = |text: &str, row| left(text, row, &Printed::new());
        assert!(left(page, row).is_empty());
        assert_eq!(left(&format!("{page}5 %\n## B 6\n4"), row), ["5", "4"]);
        assert!(left("5 %", "row = \"\"\nstated_by = \"the paper\"").is_empty());
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
