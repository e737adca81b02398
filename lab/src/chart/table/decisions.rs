//! A stranger's rows: what his detector said in his own recordings, as CSV, scored as every other row.
//!
//! A row of the file is a recording: `name,finger,kind,seconds,slips,said`. `name` is the row of the table, `finger` a number of its
//! own for each fingertip, `kind` one of `slips`, `quiet` and `disturbed`. A slip is `micro/macro/end/mm` ([`onsets`]), what was said
//! `from/to`, all in seconds from the recording's start, joined by `;`.

use anyhow::{Context, bail, ensure};
use serde::Deserialize;
use tenax_sim::scorer::{Verdict, onsets};

use super::Line;
use super::heard::{Heard, Kind};
use super::scored::Scored;

#[derive(Debug, Deserialize)]
struct Recorded {
    name: String,
    finger: u64,
    kind: String,
    seconds: f64,
    slips: String,
    said: String,
}

impl Recorded {
    fn heard(&self) -> anyhow::Result<Heard> {
        let kind = match self.kind.as_str() {
            "slips" => Kind::Slips,
            "quiet" => Kind::Quiet,
            "disturbed" => Kind::Disturbed,
            other => bail!("`{other}` is no kind; one is slips, quiet or disturbed"),
        };
        ensure!(self.seconds > 0.0, "it lasts {} s", self.seconds);
        let said = self.said.split(';').filter(|own| !own.trim().is_empty()).map(one);
        Ok(Heard {
            finger: self.finger,
            kind,
            span_s: (0.0, self.seconds),
            slips: onsets::parse(&self.slips).map_err(anyhow::Error::msg)?,
            said: vec![said.collect::<anyhow::Result<_>>()?],
        })
    }
}

fn one(text: &str) -> anyhow::Result<Verdict> {
    let wrong = || format!("`{text}` is nothing said; one is from/to, in seconds, such as 1.5/1.62");
    let (from, to) = text.trim().split_once('/').with_context(wrong)?;
    let from_s: f64 = from.parse().with_context(wrong)?;
    let to_s: f64 = if to.is_empty() { f64::INFINITY } else { to.parse().with_context(wrong)? };
    ensure!(from_s <= to_s, wrong());
    Ok(Verdict::new(from_s, to_s))
}

/// The rows of a file, in its order; `called` is what it is named. Their costs are null. An error says which line is wrong.
pub fn rows(file: &str, called: &str) -> anyhow::Result<Vec<Line>> {
    let mut rows: Vec<(String, Vec<Heard>)> = Vec::new();
    for (n, recorded) in csv::Reader::from_reader(file.as_bytes()).deserialize().enumerate() {
        let at = || format!("{called}, line {}", n + 2);
        let recorded: Recorded = recorded.with_context(at)?;
        let heard = recorded.heard().with_context(at)?;
        match rows.iter_mut().find(|(name, _)| *name == recorded.name) {
            Some((_, all)) => all.push(heard),
            None => rows.push((recorded.name, vec![heard])),
        }
    }
    ensure!(!rows.is_empty(), "{called} has no recording");
    for (_, heard) in &mut rows {
        heard.sort_by_key(|own| own.finger);
    }
    Ok(rows.iter().map(|(name, heard)| Line::new(name, called, &Scored::of(heard, 0..1), None)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "name,finger,kind,seconds,slips,said\n";

    #[test]
    fn a_strangers_decisions_become_a_row() {
        let file = format!(
            "{HEADER}mine,1,slips,20,1.0/1.1/1.5/2.0;5.0/5.1/5.4/0.3,1.08/1.2;9.0/9.1\nmine,2,slips,20,3.0//3.2/0,\n\
             mine,1,quiet,1800,,12/13\nmine,2,disturbed,3600,,\nother,1,slips,10,1.0/1.1/1.5/2.0,\n"
        );
        let rows = rows(&file, "file.csv").unwrap();
        let [mine, other] = &rows[..] else { panic!("{rows:?}") };
        assert_eq!((mine.recall_1mm, mine.recall_0_1mm.map(|own| own.value)), (Some(1.0), Some(0.5)));
        assert_eq!((mine.false_per_hour_quiet, mine.false_per_hour_disturbed), (Some(2.0), Some(0.0)));
        assert_eq!(mine.latency_ms_p50.map(f64::round), Some(-20.0));
        assert_eq!(
            (other.recall_1mm, other.false_per_hour_quiet, other.instructions_mean),
            (Some(0.0), None, None)
        );
    }

    #[test]
    fn what_cannot_be_read_is_said_with_its_line() {
        for (row, word) in [
            ("mine,1,loud,20,,", "loud"),
            ("mine,1,quiet,0,,", "lasts"),
            ("mine,1,quiet,9,,5/4", "5/4"),
            ("mine,1,quiet,9,1/2,", "1/2"),
        ] {
            let error = format!("{:#}", rows(&format!("{HEADER}{row}\n"), "file.csv").unwrap_err());
            assert!(error.contains("line 2") && error.contains(word), "{error}");
        }
        assert!(rows(HEADER, "file.csv").is_err());
    }
}
