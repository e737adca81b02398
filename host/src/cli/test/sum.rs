//! What all test programs of a run said together: what was ignored is told with its reason, and counted apart from what passed.

use std::fmt;
use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Stdio};

use anyhow::Context;

use super::workspace;

/// How many tests ended how.
#[derive(Debug, Default)]
pub struct Sum {
    passed: u32,
    failed: u32,
    ignored: u32,
    /// Test programs that did not compile or ended without a result.
    broken: u32,
    /// The lines of tests that were ignored, each with its reason.
    reasons: Vec<String>,
    /// What each test said: a line of `ok`, `FAILED` or `ignored` and its path.
    pub results: String,
}

impl Sum {
    /// Runs `cargo test`, shows what it says, and counts. Fails if it does not start.
    pub fn run(&mut self, command: &mut Command) -> anyhow::Result<()> {
        let shown = format!("{command:?}").replace('"', "");
        eprintln!("$ {shown}");
        let mut child = command
            .current_dir(workspace::root()?)
            .stdout(Stdio::piped())
            .spawn()
            .with_context(|| format!("cannot start {shown}"))?;
        let failed = self.failed;
        let mut out = BufReader::new(child.stdout.take().context("its output is piped")?);
        let mut line = Vec::new();
        while out.read_until(b'\n', &mut line)? > 0 {
            std::io::stdout().write_all(&line)?;
            self.hear(String::from_utf8_lossy(&line).trim_end());
            line.clear();
        }
        if !child.wait()?.success() && self.failed == failed {
            self.broken += 1;
        }
        Ok(())
    }

    /// One line of a test program.
    fn hear(&mut self, line: &str) {
        if let Some(counts) = line.strip_prefix("test result: ") {
            let count = |what: &str| -> u32 {
                let mut words = counts.split([';', '.']).filter_map(|part| part.trim().strip_suffix(what));
                words.next().and_then(|number| number.trim().parse().ok()).unwrap_or_default()
            };
            self.passed += count("passed");
            self.failed += count("failed");
            self.ignored += count("ignored");
        } else if let Some((path, result)) =
            line.strip_prefix("test ").and_then(|line| line.split_once(" ... "))
        {
            let word = result.split([',', ' ']).next().unwrap_or_default();
            if word == "ignored" {
                self.reasons.push(line.to_owned());
            }
            self.results.push_str(&format!("{word} {path}\n"));
        }
    }

    /// Whether nothing failed.
    pub const fn good(&self) -> bool {
        self.failed == 0 && self.broken == 0
    }
}

impl fmt::Display for Sum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for reason in &self.reasons {
            writeln!(f, "{reason}")?;
        }
        if self.broken > 0 {
            writeln!(f, "{} runs of cargo failed without a failed test", self.broken)?;
        }
        write!(f, "{} passed, {} failed, {} ignored", self.passed, self.failed, self.ignored)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_ignored_is_counted_apart_and_told_with_its_reason() {
        let mut sum = Sum::default();
        for line in [
            "running 3 tests",
            "test the_rig ... ignored, no recordings in ../shared/data",
            "test result: ok. 2 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 8.49s",
            "test result: FAILED. 9 passed; 1 failed; 0 ignored; 0 measured; 7 filtered out; finished in 0.75s",
        ] {
            sum.hear(line);
        }
        let told =
            "test the_rig ... ignored, no recordings in ../shared/data\n11 passed, 1 failed, 1 ignored";
        assert_eq!(sum.to_string(), told);
        assert!(!sum.good());
    }

    #[test]
    fn a_run_that_ends_without_a_failed_test_is_no_success() {
        let mut sum = Sum::default();
        let said = "printf 'running 1 test\\ntest result: ok. 1 passed; 0 failed; 0 ignored\\n'; exit 101";
        sum.run(Command::new("sh").args(["-c", said])).expect("it starts");
        assert!(!sum.good() && sum.passed == 1, "{sum}");
    }
}
