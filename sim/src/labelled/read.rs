//! A CSV file, read with a recipe.

use std::io::Read;
use std::path::Path;

use csv::StringRecord;
use tenax_hal_shim::channel::{ARRAY_COUNT, SAMPLE_MAX, SLOW_HZ};

use super::recipe::ArrayRecipe;
use super::{Part, Recording, Step};
use crate::input::{CsvError, Table, open, rows};
use crate::scorer::{Doing, SlipSpan, onsets};

const GAP_MAX_S: f64 = 0.5;

pub fn read(path: &Path, recipe: &ArrayRecipe) -> Result<Vec<Recording>, CsvError> {
    let (source, file) = open(path)?;
    parse(source, recipe, &file)
}

/// Recordings in the order of their first rows; `file` is its name in errors, which say the row and what is allowed.
pub fn parse(source: impl Read, recipe: &ArrayRecipe, file: &str) -> Result<Vec<Recording>, CsvError> {
    let table = Table::default();
    let mut reader = rows(source, &table).map_err(|error| CsvError::of(file, error.into()))?;
    let header = reader.headers().map_err(|error| CsvError::of(file, error))?.clone();
    let columns = Columns::find(&header, recipe, file)?;
    let mut all: Vec<Open> = Vec::new();
    for record in reader.into_records() {
        let record = record.map_err(|error| CsvError::of(file, error))?;
        let line = record.position().map_or(0, csv::Position::line);
        let wrong = |what| CsvError::Row { file: file.to_owned(), line, what };
        columns.take(&record, (recipe, &table), &mut all).map_err(wrong)?;
    }
    if all.is_empty() {
        return Err(CsvError::File { file: file.to_owned(), what: "no rows below the header".into() });
    }
    Ok(all.into_iter().map(|open| open.close(columns.onsets.is_some())).collect())
}

struct Columns {
    array: [usize; ARRAY_COUNT],
    label: usize,
    time: Option<usize>,
    name: Option<usize>,
    session: Option<usize>,
    material: Option<usize>,
    part: Option<usize>,
    task: Option<usize>,
    onsets: Option<usize>,
}

#[derive(Clone, PartialEq)]
struct About {
    name: String,
    session: String,
    material: String,
    part: Option<Part>,
    doing: Doing,
}

struct Open {
    about: About,
    t_s: Vec<f64>,
    samples: Vec<[f64; ARRAY_COUNT]>,
    labels: Vec<bool>,
    slips: Vec<SlipSpan>,
}

impl Columns {
    fn find(header: &StringRecord, recipe: &ArrayRecipe, file: &str) -> Result<Self, CsvError> {
        let if_there =
            |column: Option<&String>| column.and_then(|column| header.iter().position(|name| name == column));
        let place = |column: &String| {
            if_there(Some(column)).ok_or_else(|| {
                let why = format!("no column `{column}`, which the recipe asks for");
                CsvError::no_column(file, &why, header, "")
            })
        };
        let maybe = |column: Option<&String>| column.map(place).transpose();
        let mut array = [0; ARRAY_COUNT];
        for (found, column) in array.iter_mut().zip(recipe.array.columns.get_ref()) {
            *found = place(column)?;
        }
        Ok(Self {
            array,
            label: place(&recipe.labels.column)?,
            time: maybe(recipe.array.time.as_ref())?,
            name: maybe(recipe.recordings.name.as_ref())?,
            session: maybe(recipe.recordings.session.as_ref())?,
            material: maybe(recipe.recordings.material.as_ref())?,
            part: maybe(recipe.recordings.part.as_ref())?,
            task: if_there(recipe.recordings.task.as_ref()),
            onsets: if_there(recipe.labels.onsets.as_ref()),
        })
    }

    fn about(&self, record: &StringRecord) -> Result<About, String> {
        let text = |place: Option<usize>| place.map(|place| record[place].to_owned());
        let name = text(self.name).unwrap_or_else(|| "recording".into());
        let session = text(self.session).unwrap_or_else(|| name.clone());
        Ok(About {
            material: text(self.material).unwrap_or_else(|| session.clone()),
            part: self.part.map(|place| record[place].parse()).transpose()?,
            doing: self.task.map_or(Doing::Unknown, |place| Doing::named(&record[place])),
            name,
            session,
        })
    }

    fn take(
        &self,
        record: &StringRecord,
        (recipe, table): (&ArrayRecipe, &Table),
        all: &mut Vec<Open>,
    ) -> Result<(), String> {
        let about = self.about(record)?;
        let name = &about.name;
        let place = all.iter().rposition(|open| open.about.name == *name).unwrap_or_else(|| {
            all.push(Open::new(about.clone()));
            all.len() - 1
        });
        let open = &mut all[place];
        if open.about != about {
            return Err(format!("recording `{name}` changes its session, material, part or task here"));
        }
        let t_s = match (self.time, &recipe.array.time, &recipe.array.rate_hz) {
            (Some(place), Some(column), _) => table.number(column, &record[place])?,
            (.., Some(rate_hz)) => open.t_s.len() as f64 / rate_hz.get_ref(),
            _ => return Err("neither time nor rate is known".into()),
        };
        let before = *open.t_s.last().unwrap_or(&t_s);
        if t_s < before {
            return Err(format!("time goes backwards in recording `{name}`, from {before} s to {t_s} s"));
        }
        if t_s - before > GAP_MAX_S {
            return Err(format!(
                "recording `{name}` has a gap of {:.3} s, longer than {GAP_MAX_S} s; make it two recordings (is its time in \
                 seconds?)",
                t_s - before
            ));
        }
        let mut samples = [0.0; ARRAY_COUNT];
        for ((sample, &place), column) in
            samples.iter_mut().zip(&self.array).zip(recipe.array.columns.get_ref())
        {
            *sample =
                recipe.array.offset + recipe.array.scale.get_ref() * table.number(column, &record[place])?;
        }
        open.t_s.push(t_s);
        open.samples.push(samples);
        open.labels.push(recipe.labels.is_slip(&record[self.label])?);
        open.slips.extend(self.onsets.map_or(Ok(Vec::new()), |place| onsets::parse(&record[place]))?);
        Ok(())
    }
}

impl Open {
    const fn new(about: About) -> Self {
        Self { about, t_s: Vec::new(), samples: Vec::new(), labels: Vec::new(), slips: Vec::new() }
    }

    fn close(mut self, exact: bool) -> Recording {
        let step = |(row, part): (usize, f64)| {
            let next = (row + 1).min(self.samples.len() - 1);
            let (a, b) = (self.samples[row], self.samples[next]);
            let sample =
                |n: usize| (a[n] + part * (b[n] - a[n])).round().clamp(0.0, f64::from(SAMPLE_MAX)) as u16;
            Step {
                samples: std::array::from_fn(sample),
                slip: self.labels[if part < 0.5 { row } else { next }],
            }
        };
        let steps: Vec<Step> = instants(&self.t_s).into_iter().map(step).collect();
        let first_s = self.t_s.first().copied().unwrap_or_default();
        if !exact {
            self.slips = onsets::of_labels(steps.iter().map(|step| step.slip), first_s);
        }
        self.slips.sort_by(|a, b| a.micro_onset_s.total_cmp(&b.micro_onset_s));
        let About { name, session, material, part, doing } = self.about;
        Recording { name, session, material, part, doing, first_s, steps, slips: self.slips, exact }
    }
}

/// Places on a recording's own rows at which the board would have read: row, and how far on the way to the next. A recording faster than
/// 80 Hz is not low-passed first: the board's switched inputs would not do so either.
fn instants(t_s: &[f64]) -> Vec<(usize, f64)> {
    let (Some(&first), Some(&last)) = (t_s.first(), t_s.last()) else { return Vec::new() };
    let rate_hz = f64::from(SLOW_HZ);
    // A hair more, so that a last row that is there but for rounding counts.
    let count = ((last - first) * rate_hz + 1e-6) as usize + 1;
    let mut row = 0;
    let place = |n: usize| {
        let t = first + n as f64 / rate_hz;
        while row + 2 < t_s.len() && t_s[row + 1] <= t {
            row += 1;
        }
        match t_s.get(row + 1) {
            Some(&next) if next > t_s[row] => (row, ((t - t_s[row]) / (next - t_s[row])).clamp(0.0, 1.0)),
            _ => (row, 0.0),
        }
    };
    (0..count).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::Kind;

    const RECIPE: &str = "\
title = 't'
description = 'd'
[array]
columns = ['a', 'b', 'c', 'd', 'e', 'f', 'g', 'h', 'i', 'j']
scale = 2
offset = 10
time = 't'
[recordings]
name = 'r'
part = 'part'
[labels]
column = 'label'
slip = ['yes']
no_slip = ['no']
";

    fn read(rows: &str) -> Result<Vec<Recording>, CsvError> {
        let recipe = ArrayRecipe::parse(RECIPE, "r.toml").unwrap();
        parse(format!("r,part,label,t,a,b,c,d,e,f,g,h,i,j\n{rows}").as_bytes(), &recipe, "d.csv")
    }

    #[test]
    fn rows_become_samples_at_80_hz() {
        let rows = "x,train,no,0,0,0,0,0,0,0,0,0,0,0\ny,test,no,5,0,0,0,0,0,0,0,0,0,9e9\n\
                    x,train,yes,0.05,100,0,0,0,0,0,0,0,0,-100\n";
        let read = read(rows).unwrap();
        assert_eq!(read.len(), 2);
        assert_eq!(read[0].part, Some(Part::Train));
        assert_eq!(read[0].session, "x");
        let first: Vec<u16> = read[0].steps.iter().map(|step| step.samples[0]).collect();
        assert_eq!(first, [10, 60, 110, 160, 210]);
        let slips: Vec<bool> = read[0].steps.iter().map(|step| step.slip).collect();
        assert_eq!(slips, [false, false, true, true, true]);
        assert_eq!(read[0].steps[4].samples[9], 0);
        assert_eq!(read[1].steps[0].samples[9], SAMPLE_MAX);
    }

    #[test]
    fn mistakes_are_answered_with_their_row() {
        let good = "x,train,no,0,0,0,0,0,0,0,0,0,0,0\n";
        for (row, says) in [
            ("x,train,no,0.1,0,0,0,0,0,oops,0,0,0,0\n", "column `f` is `oops`, which is not a number"),
            ("x,train,no,0.1,0,0,0,0,0,nan,0,0,0,0\n", "only finite numbers"),
            ("x,train,maybe,0.1,0,0,0,0,0,0,0,0,0,0\n", "the recipe knows yes (slip) and no (none)"),
            ("x,exam,no,0.1,0,0,0,0,0,0,0,0,0,0\n", "train, validation and test"),
            ("x,test,no,0.1,0,0,0,0,0,0,0,0,0,0\n", "changes its session, material, part or task"),
            ("x,train,no,-0.1,0,0,0,0,0,0,0,0,0,0\n", "time goes backwards"),
            ("x,train,no,2.0,0,0,0,0,0,0,0,0,0,0\n", "gap of 2.000 s"),
            ("x,train,no,0.1,0,0,0,0\n", "8 cells, but the header has 14"),
        ] {
            let said = read(&format!("{good}{row}")).unwrap_err().to_string();
            assert!(said.starts_with("d.csv:3: ") && said.contains(says), "{row}: {said}");
        }
        assert!(read("").unwrap_err().to_string().contains("no rows"));
        let recipe = ArrayRecipe::parse(RECIPE, "r.toml").unwrap();
        let said = parse("r,part,label,t\n".as_bytes(), &recipe, "d.csv").unwrap_err().to_string();
        assert!(said.starts_with("d.csv:1: no column `a`"), "{said}");
    }

    #[test]
    fn a_straight_line_at_another_rate_stays_one() {
        let t_s = [0.0, 0.01, 0.02, 0.02, 0.045, 0.1];
        for (n, (row, part)) in instants(&t_s).into_iter().enumerate() {
            let t = t_s[row] + part * (t_s.get(row + 1).unwrap_or(&t_s[row]) - t_s[row]);
            assert!((t - n as f64 * 0.0125).abs() < 1e-9, "{n}: {t}");
        }
        assert_eq!(instants(&t_s).len(), 9);
        assert_eq!(instants(&[3.0]), [(0, 0.0)]);
        assert!(instants(&[]).is_empty());
    }
}
