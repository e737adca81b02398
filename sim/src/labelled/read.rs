//! A CSV file, read with a recipe.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

use csv::StringRecord;
use tenax_hal_shim::channel::{ARRAY_COUNT, SAMPLE_MAX};

use super::recipe::ArrayRecipe;
use super::resample::instants;
use super::{Part, Recording, Step};
use crate::input::{CsvError, number, open, rows};
use crate::scorer::{Doing, SlipSpan, onsets};

const GAP_MAX_S: f64 = 0.5;

pub fn read(path: &Path, recipe: &ArrayRecipe) -> Result<Vec<Recording>, CsvError> {
    let (source, file) = open(path)?;
    parse(source, recipe, &file)
}

/// Reads from anything; `file` is what errors call it. Recordings come in the order of their first rows.
/// An error says which row is wrong, and what is allowed.
pub fn parse(source: impl Read, recipe: &ArrayRecipe, file: &str) -> Result<Vec<Recording>, CsvError> {
    let mut reader = rows(source);
    let header = reader.headers().map_err(|error| CsvError::of(file, error))?.clone();
    let columns = Columns::find(&header, recipe, file)?;
    let mut order: Vec<Open> = Vec::new();
    let mut places: BTreeMap<String, usize> = BTreeMap::new();
    for record in reader.into_records() {
        let record = record.map_err(|error| CsvError::of(file, error))?;
        let line = record.position().map_or(0, csv::Position::line);
        let wrong = |what| CsvError::Row { file: file.to_owned(), line, what };
        let row = columns.row(&record, recipe).map_err(wrong)?;
        let place = *places.entry(row.about.name.clone()).or_insert_with(|| {
            order.push(Open::new(row.about.clone()));
            order.len() - 1
        });
        order[place].take(row, recipe).map_err(wrong)?;
    }
    if order.is_empty() {
        return Err(CsvError::File { file: file.to_owned(), what: "no rows below the header".into() });
    }
    Ok(order.into_iter().map(|open| open.close(columns.onsets.is_some())).collect())
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

struct Row {
    about: About,
    t_s: Option<f64>,
    samples: [f64; ARRAY_COUNT],
    slip: bool,
    slips: Vec<SlipSpan>,
}

impl Columns {
    fn find(header: &StringRecord, recipe: &ArrayRecipe, file: &str) -> Result<Self, CsvError> {
        let place = |column: &str| {
            header.iter().position(|name| name == column).ok_or_else(|| {
                let why = format!("no column `{column}`, which the recipe asks for");
                CsvError::no_column(file, &why, header)
            })
        };
        let maybe = |column: Option<&String>| column.map(|column| place(column)).transpose();
        let if_there =
            |column: Option<&String>| column.and_then(|column| header.iter().position(|name| name == column));
        let mut array = [0; ARRAY_COUNT];
        for (found, column) in array.iter_mut().zip(recipe.array.columns.get_ref()) {
            *found = place(column)?;
        }
        Ok(Self {
            array,
            label: place(&recipe.labels.column)?,
            time: maybe(recipe.array.time.as_ref().map(toml::Spanned::get_ref))?,
            name: maybe(recipe.recordings.name.as_ref())?,
            session: maybe(recipe.recordings.session.as_ref())?,
            material: maybe(recipe.recordings.material.as_ref())?,
            part: maybe(recipe.recordings.part.as_ref())?,
            task: if_there(recipe.recordings.task.as_ref()),
            onsets: if_there(recipe.labels.onsets.as_ref()),
        })
    }

    fn row(&self, record: &StringRecord, recipe: &ArrayRecipe) -> Result<Row, String> {
        let number = |place: usize, column: &str| number(column, &record[place]);
        let mut samples = [0.0; ARRAY_COUNT];
        for ((sample, &place), column) in
            samples.iter_mut().zip(&self.array).zip(recipe.array.columns.get_ref())
        {
            *sample = recipe.array.offset + recipe.array.scale.get_ref() * number(place, column)?;
        }
        let label = &record[self.label];
        let means = |values: &toml::Spanned<Vec<String>>| values.get_ref().iter().any(|value| value == label);
        let slip = means(&recipe.labels.slip);
        if !slip && !means(&recipe.labels.no_slip) {
            let known = [recipe.labels.slip.get_ref().join(", "), recipe.labels.no_slip.get_ref().join(", ")];
            let column = &recipe.labels.column;
            return Err(format!(
                "column `{column}` is `{label}`; the recipe knows {} (slip) and {} (none)",
                known[0], known[1]
            ));
        }
        let text = |place: Option<usize>| place.map(|place| record[place].to_owned());
        let name = text(self.name).unwrap_or_else(|| "recording".into());
        let session = text(self.session).unwrap_or_else(|| name.clone());
        let about = About {
            material: text(self.material).unwrap_or_else(|| session.clone()),
            part: self.part.map(|place| record[place].parse::<Part>()).transpose()?,
            doing: self.task.map_or(Doing::Unknown, |place| Doing::named(&record[place])),
            name,
            session,
        };
        Ok(Row {
            about,
            t_s: match (self.time, &recipe.array.time) {
                (Some(place), Some(column)) => Some(number(place, column.get_ref())?),
                _ => None,
            },
            slips: self.onsets.map_or(Ok(Vec::new()), |place| onsets::parse(&record[place]))?,
            samples,
            slip,
        })
    }
}

struct Open {
    about: About,
    t_s: Vec<f64>,
    samples: Vec<[f64; ARRAY_COUNT]>,
    labels: Vec<bool>,
    slips: Vec<SlipSpan>,
}

impl Open {
    const fn new(about: About) -> Self {
        Self { about, t_s: Vec::new(), samples: Vec::new(), labels: Vec::new(), slips: Vec::new() }
    }

    fn take(&mut self, row: Row, recipe: &ArrayRecipe) -> Result<(), String> {
        let name = &self.about.name;
        if self.about != row.about {
            return Err(format!("recording `{name}` changes its session, material, part or task here"));
        }
        let t_s = match (row.t_s, &recipe.array.rate_hz) {
            (Some(t_s), _) => t_s,
            (None, Some(rate_hz)) => self.t_s.len() as f64 / rate_hz.get_ref(),
            (None, None) => return Err("neither time nor rate is known".into()),
        };
        if let Some(&before) = self.t_s.last() {
            if t_s < before {
                return Err(format!("time goes backwards in recording `{name}`, from {before} s to {t_s} s"));
            }
            if t_s - before > GAP_MAX_S {
                return Err(format!(
                    "recording `{name}` has a gap of {:.3} s, longer than {GAP_MAX_S} s; make it two recordings (is its \
                     time in seconds?)",
                    t_s - before
                ));
            }
        }
        self.t_s.push(t_s);
        self.samples.push(row.samples);
        self.labels.push(row.slip);
        self.slips.extend(row.slips);
        Ok(())
    }

    fn close(mut self, exact: bool) -> Recording {
        let steps: Vec<Step> = instants(&self.t_s)
            .into_iter()
            .map(|(row, part)| {
                let next = (row + 1).min(self.samples.len() - 1);
                let mut samples = [0; ARRAY_COUNT];
                for ((sample, a), b) in samples.iter_mut().zip(self.samples[row]).zip(self.samples[next]) {
                    *sample = (a + part * (b - a)).round().clamp(0.0, f64::from(SAMPLE_MAX)) as u16;
                }
                Step { samples, slip: self.labels[if part < 0.5 { row } else { next }] }
            })
            .collect();
        let first_s = self.t_s.first().copied().unwrap_or_default();
        if !exact {
            self.slips = onsets::of_labels(steps.iter().map(|step| step.slip), first_s);
        }
        self.slips.sort_by(|a, b| a.micro_onset_s.total_cmp(&b.micro_onset_s));
        let About { name, session, material, part, doing } = self.about;
        Recording { name, session, material, part, doing, first_s, steps, slips: self.slips, exact }
    }
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
}
