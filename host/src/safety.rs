//! Requirements, hazards and tests, held against each other: `docs/safety/requirements.md`, the table of hazards in
//! `docs/safety.md`, the comments `// Shows W1, R2.` above tests, and what the tests said when they last ran.

pub mod soup;

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::Path;

use anyhow::Context;
use serde::Serialize;

/// The tests that are to be there, by requirement: one that is deleted is missed, though others show the same.
const NAMED: &str = "docs/safety/tests.txt";

/// Where `tenax test` leaves what each test said, below the workspace.
pub const RESULTS: &str = "target/test-results.txt";

/// A test that shows a requirement.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Test {
    /// Its function.
    pub name: String,
    /// Its file, below the workspace.
    pub file: String,
    /// `ok`, `FAILED`, `ignored`; none: it was not run.
    pub result: Option<String>,
}

/// A requirement, what it answers and what shows it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Requirement {
    /// Such as W1.
    pub id: String,
    /// What is required.
    pub sentence: String,
    /// The hazards that name it.
    pub hazards: Vec<String>,
    /// The tests that show it.
    pub tests: Vec<Test>,
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Matrix {
    /// In the page's order.
    pub requirements: Vec<Requirement>,
    /// Hazards that nothing keeps yet: their number and name.
    pub open: Vec<String>,
    pub problems: Vec<String>,
}

impl Matrix {
    /// Of the workspace at `root`; with `tested`, a test whose last result is not `ok` is a problem.
    ///
    /// # Errors
    /// If a file cannot be read.
    pub fn of(root: &Path, tested: bool) -> anyhow::Result<Self> {
        let read = |name: &str| {
            let path = root.join(name);
            fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))
        };
        let mut matrix = Self::default();
        for cells in rows(&read("docs/safety/requirements.md")?) {
            let [id, sentence, hazards] = &cells[..] else { continue };
            let hazards = ids(hazards);
            matrix.requirements.push(Requirement {
                id: id.clone(),
                sentence: sentence.clone(),
                hazards,
                tests: Vec::new(),
            });
        }
        for (file, id, test) in shown(root)? {
            match matrix.requirements.iter_mut().find(|requirement| requirement.id == id) {
                Some(requirement) => requirement.tests.push(Test { name: test, file, result: None }),
                None => matrix.problems.push(format!("{file}: {test} shows {id}, which is no requirement")),
            }
        }
        matrix.compare(&read(NAMED)?);
        matrix.hazards(&read("docs/safety.md")?);
        let results = fs::read_to_string(root.join(RESULTS)).ok();
        matrix.results(results.as_deref().unwrap_or_default());
        matrix.judge(tested, results.is_some());
        Ok(matrix)
    }

    /// Every requirement with each of its tests, as [`NAMED`] has them: in an order of their own.
    pub fn named(&self) -> String {
        let line = |id: &str, Test { name, file, .. }: &Test| format!("{id} {file} {name}\n");
        let mut lines: Vec<String> = self
            .requirements
            .iter()
            .flat_map(|own| own.tests.iter().map(|test| line(&own.id, test)))
            .collect();
        lines.sort();
        lines.concat()
    }

    /// The tests that are there have to be those that are named.
    fn compare(&mut self, named: &str) {
        let now = self.named();
        let only_in = |one: &str, other: &str| -> Vec<String> {
            one.lines().filter(|line| !other.lines().any(|own| own == *line)).map(str::to_owned).collect()
        };
        self.problems
            .extend(only_in(named, &now).iter().map(|line| format!("{line} is gone, and {NAMED} names it")));
        let new = only_in(&now, named);
        self.problems.extend(
            new.iter().map(|line| format!("{line} is new: run   cargo tenax safety --named > {NAMED}")),
        );
    }

    /// Both tables have to say the same of which hazard names which requirement.
    fn hazards(&mut self, page: &str) {
        let mut named: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for cells in rows(page) {
            let ([id, name, ..], Some(requirements)) = (&cells[..], cells.last()) else { continue };
            let name = name.replace("**", "");
            if requirements == "open" {
                self.open.push(format!("{id} {name}"));
                continue;
            }
            let requirements = ids(requirements);
            if requirements.is_empty() {
                self.problems.push(format!(
                    "hazard {id}, {name}: names no requirement; write `open` where none keeps it"
                ));
            }
            for requirement in requirements {
                if !self.requirements.iter().any(|own| own.id == requirement) {
                    self.problems.push(format!("hazard {id} names {requirement}, which is no requirement"));
                }
                named.entry(requirement).or_default().push(id.clone());
            }
        }
        for Requirement { id, hazards, .. } in &self.requirements {
            let mut named = named.remove(id).unwrap_or_default();
            let mut own = hazards.clone();
            named.sort();
            own.sort();
            if own != named {
                self.problems.push(format!("{id} names the hazards {own:?}, and {named:?} name it"));
            }
        }
    }

    /// Lines such as `ok emg::tests::rest_is_rest`; of two tests of one name the worse counts.
    fn results(&mut self, results: &str) {
        let mut last: BTreeMap<&str, &str> = BTreeMap::new();
        for (result, path) in results.lines().filter_map(|line| line.split_once(' ')) {
            let name = path.rsplit("::").next().unwrap_or(path);
            let worse = last.get(name).is_none_or(|before| *before == "ok");
            if worse {
                last.insert(name, result);
            }
        }
        for test in self.requirements.iter_mut().flat_map(|requirement| &mut requirement.tests) {
            test.result = last.get(test.name.as_str()).map(|result| (*result).to_owned());
        }
    }

    fn judge(&mut self, tested: bool, has_results: bool) {
        if tested && !has_results {
            self.problems.push(format!("{RESULTS} is not there: run `cargo tenax test` first"));
        }
        for Requirement { id, sentence, tests, .. } in &self.requirements {
            if tests.is_empty() {
                self.problems.push(format!("{id} has no test: {sentence}"));
            }
            for Test { name, file, result } in tests.iter().filter(|_| tested && has_results) {
                match result.as_deref() {
                    Some("ok") => {}
                    Some(other) => self.problems.push(format!("{id}: {file}: {name} {other}")),
                    None => self.problems.push(format!("{id}: {file}: {name} was not run")),
                }
            }
        }
    }
}

impl fmt::Display for Matrix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for Requirement { id, sentence, hazards, tests } in &self.requirements {
            let answers = if hazards.is_empty() { "the contract".to_owned() } else { hazards.join(", ") };
            writeln!(f, "{id:<4}{sentence} [{answers}]")?;
            for Test { name, file, result } in tests {
                writeln!(f, "    {:<8} {file}: {name}", result.as_deref().unwrap_or("-"))?;
            }
        }
        for hazard in &self.open {
            writeln!(f, "open    {hazard}")?;
        }
        for problem in &self.problems {
            writeln!(f, "PROBLEM {problem}")?;
        }
        let tests: usize = self.requirements.iter().map(|requirement| requirement.tests.len()).sum();
        writeln!(
            f,
            "{} requirements, {tests} tests that show them, {} hazards open, {} problems",
            self.requirements.len(),
            self.open.len(),
            self.problems.len()
        )
    }
}

/// The rows of a page's tables whose first cell is a letter and a number: their cells.
fn rows(page: &str) -> Vec<Vec<String>> {
    let is_id = |cell: &String| {
        let mut letters = cell.chars();
        letters.next().is_some_and(|c| c.is_ascii_uppercase())
            && cell.len() > 1
            && letters.all(|c| c.is_ascii_digit())
    };
    let cells = |line: &str| -> Vec<String> {
        line.trim()
            .trim_start_matches('|')
            .trim_end_matches('|')
            .split('|')
            .map(|cell| cell.trim().to_owned())
            .collect()
    };
    page.lines()
        .filter(|line| line.starts_with('|'))
        .map(cells)
        .filter(|cells| cells.first().is_some_and(is_id))
        .collect()
}

/// Such as `W1, R2`; nothing of words.
fn ids(cell: &str) -> Vec<String> {
    let is_id = |word: &&str| word.len() > 1 && word[1..].chars().all(|c| c.is_ascii_digit());
    cell.split(", ").filter(is_id).map(str::to_owned).collect()
}

/// Every test with a comment that names a requirement: its file, the requirement, its name.
fn shown(root: &Path) -> anyhow::Result<Vec<(String, String, String)>> {
    let mut shown = Vec::new();
    for pattern in ["*/src/**/*.rs", "*/tests/**/*.rs"] {
        let pattern = root.join(pattern);
        for path in glob::glob(&pattern.to_string_lossy())?.flatten() {
            let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
            let file = path.strip_prefix(root).unwrap_or(&path).display().to_string();
            let mut waiting: Vec<String> = Vec::new();
            for line in text.lines().map(str::trim) {
                if let Some(named) = line.strip_prefix("// Shows ") {
                    waiting = ids(named.trim_end_matches('.'));
                } else if let Some(rest) = line.strip_prefix("fn ")
                    && !waiting.is_empty()
                {
                    let name = rest.split(['(', '<']).next().unwrap_or(rest);
                    shown.extend(waiting.drain(..).map(|id| (file.clone(), id, name.to_owned())));
                }
            }
        }
    }
    Ok(shown)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn workspace() -> &'static Path {
        Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
    }

    #[test]
    fn the_matrix_of_this_project_is_complete() {
        let matrix = Matrix::of(workspace(), false).unwrap();
        assert!(matrix.requirements.len() > 25 && matrix.problems.is_empty(), "{matrix}");
    }

    /// A copy of what the matrix is made of, with `change` made of one file's text.
    fn problems(of: &str, change: impl Fn(&str) -> String) -> Vec<String> {
        let copy = tempfile::tempdir().unwrap();
        let mut files: Vec<String> = shown(workspace()).unwrap().into_iter().map(|(file, ..)| file).collect();
        files.extend(["docs/safety.md", "docs/safety/requirements.md", NAMED].map(str::to_owned));
        files.sort();
        files.dedup();
        for file in files {
            let text = fs::read_to_string(workspace().join(&file)).unwrap();
            let text = if file == of { change(&text) } else { text };
            let path = copy.path().join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        Matrix::of(copy.path(), false).unwrap().problems
    }

    #[test]
    fn a_requirement_that_loses_its_last_test_or_its_hazard_is_a_problem() {
        assert_eq!(problems("no file", str::to_owned), Vec::<String>::new());
        // The only test of its kind: with its comment gone the requirement has none.
        let file = "logic/src/mode.rs";
        let lost = problems(file, |text| text.replace("// Shows R1.", ""));
        assert_eq!(lost.len(), 2, "two others show it, and both of this file are missed: {lost:?}");
        assert!(lost.iter().all(|problem| problem.contains("is gone")), "{lost:?}");
        let lost = problems("docs/safety/requirements.md", |text| text.replace("| W4 |", "| W9 |"));
        assert!(lost.iter().any(|problem| problem.contains("shows W4, which is no requirement")), "{lost:?}");
        assert!(lost.iter().any(|problem| problem.contains("names W4, which is no requirement")), "{lost:?}");
        assert!(lost.iter().any(|problem| problem.contains("W9 has no test")), "{lost:?}");
        let lost = problems("docs/safety.md", |text| text.replace(" | R8 |", " | |"));
        assert!(lost.iter().any(|problem| problem.contains("names no requirement")), "{lost:?}");
    }

    #[test]
    fn any_named_test_that_is_deleted_is_a_problem() {
        let matrix = Matrix::of(workspace(), false).unwrap();
        for (place, requirement) in matrix.requirements.iter().enumerate() {
            for (n, test) in requirement.tests.iter().enumerate() {
                let mut without = Matrix { problems: Vec::new(), ..matrix.clone() };
                without.requirements[place].tests.remove(n);
                without.compare(&matrix.named());
                let expected = format!("{} {} {} is gone", requirement.id, test.file, test.name);
                assert!(
                    without.problems.len() == 1 && without.problems[0].starts_with(&expected),
                    "{without}"
                );
            }
        }
    }

    #[test]
    fn a_test_that_is_gone_failed_or_was_ignored_is_a_problem_after_the_tests_ran() {
        let mut matrix = Matrix::of(workspace(), false).unwrap();
        let names: Vec<String> =
            matrix.requirements.iter().flat_map(|own| &own.tests).map(|test| test.name.clone()).collect();
        let all = |without: &str, result: &str| -> String {
            let line = |name: &String| {
                let result = if name == without { result } else { "ok" };
                if result.is_empty() { String::new() } else { format!("{result} module::{name}\n") }
            };
            names.iter().map(line).collect()
        };
        for name in &names {
            for (result, word) in [("", "was not run"), ("FAILED", "FAILED"), ("ignored", "ignored")] {
                let mut own = Matrix { problems: Vec::new(), ..matrix.clone() };
                own.results(&all(name, result));
                own.judge(true, true);
                assert!(own.problems.iter().all(|problem| problem.ends_with(&format!("{name} {word}"))));
                assert!(!own.problems.is_empty(), "{name} {word}");
            }
        }
        matrix.results(&all("", ""));
        matrix.judge(true, true);
        assert_eq!(matrix.problems, Vec::<String>::new());
    }
}
