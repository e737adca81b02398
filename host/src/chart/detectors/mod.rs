//! The chart of `tenax chart detectors`: what each classifier gets right for the instructions that it takes.

mod table;

use std::collections::BTreeMap;

use anyhow::Result;
use plotters::style::RGBColor;

use self::table::{Measured, Row};
use super::draw::INK;
use super::sheet::{Axis, Mark, Panel, Series, Sheet};
use super::{Chart, csv, draw};
use crate::plot::figure::colour;

/// A hundredth of what the core executes in a slow frame, at 100 MHz and one instruction a cycle.
const LOAD_BAR: f64 = 12_500.0;
/// Steps wrong, %, that an axis begins at: nobody's test set is large enough for less.
const LEAST_WRONG: f64 = 0.01;

/// Joins the table of scores (CSV, as [`Row`] describes it) with the instructions that each kernel took, and draws it.
///
/// # Errors
/// Says which line of the table is wrong, or has no kernel.
pub fn chart(table: &str, instructions: &BTreeMap<String, u64>) -> Result<Chart> {
    let mut all = table::read(table, instructions)?;
    all.sort_by(|a, b| a.instructions.cmp(&b.instructions).then(b.row.accuracy.total_cmp(&a.row.accuracy)));
    let front = front(&all);
    let rows = all.iter().enumerate().map(|(n, measured)| {
        let Row { classifier, precision, window, lookback, accuracy, missed, false_alarms, shipped } =
            &measured.row;
        let mut row = vec![classifier.clone(), precision.clone(), window.clone(), lookback.to_string()];
        row.extend([format!("{accuracy:.5}"), missed.to_string(), false_alarms.to_string()]);
        row.extend([measured.instructions.to_string(), front.contains(&n).to_string(), shipped.to_string()]);
        row
    });
    let header = [
        "classifier",
        "precision",
        "window",
        "lookback",
        "accuracy",
        "missed",
        "false",
        "instructions",
        "front",
        "shipped",
    ];
    let csv = csv(&header, rows)?;
    let sheet = Sheet {
        title: "Slip from normal force alone: what it gets wrong against what it takes".to_owned(),
        subtitle:
            "Held-out sessions. Instructions of one slow frame (12.5 ms), features included, counted on the \
                   emulated Cortex-M4."
                .to_owned(),
        columns: 1,
        panels: vec![panel(&all, &front)],
        errors: None,
    };
    Ok(Chart { name: "detectors-cost", svg: draw::svg(&sheet)?, csv })
}

/// Of points by rising cost: those that nothing as cheap is better than.
fn front(all: &[Measured]) -> Vec<usize> {
    let mut best = f64::NEG_INFINITY;
    let mut front = Vec::new();
    for (n, measured) in all.iter().enumerate() {
        if measured.row.accuracy > best {
            best = measured.row.accuracy;
            front.push(n);
        }
    }
    front
}

fn panel(all: &[Measured], front: &[usize]) -> Panel {
    let at = |measured: &Measured| (measured.instructions as f64, measured.wrong_percent().max(LEAST_WRONG));
    let points: Vec<_> = all.iter().map(at).collect();
    let ends = |pick: fn(&(f64, f64)) -> f64| {
        let values = points.iter().map(pick);
        (values.clone().fold(f64::INFINITY, f64::min), values.fold(0.0, f64::max))
    };
    let (cheapest, dearest) = ends(|point| point.0);
    let (best, worst) = ends(|point| point.1);
    let decades = |from: f64, to: f64| (10_f64.powf(from.log10().floor()), 10_f64.powf(to.log10().ceil()));
    let (from, to) = decades(best / 1.2, worst * 1.2);
    let y = Axis::log("steps wrong, %", from, to);
    let (from, to) = decades(cheapest / 1.2, dearest.max(LOAD_BAR) * 1.2);
    let x = Axis::log("instructions a slow frame", from, to);

    let mut names: Vec<&str> = all.iter().map(|measured| measured.row.classifier.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let mut series: Vec<Series> = names
        .iter()
        .zip(COLOURS.iter().cycle())
        .map(|(name, &colour)| {
            let own = all.iter().filter(|measured| measured.row.classifier == *name).map(at).collect();
            one(name, colour, Mark::Dots, own)
        })
        .collect();
    series.push(one("front", INK, Mark::Dashes, front.iter().map(|&n| points[n]).collect()));
    let bar = vec![(LOAD_BAR, y.ends.0), (LOAD_BAR, y.ends.1)];
    series.push(one("1 % of 100 MHz", colour::GREY, Mark::Line, bar));
    let shipped = all.iter().filter(|measured| measured.row.shipped).map(at).collect();
    series.push(one("shipped", colour::VERMILLION, Mark::Rings, shipped));
    let words = all.iter().zip(&points).map(|(measured, &(x, y))| (x, y, measured.row.variant())).collect();
    Panel {
        title: "each dot is one classifier, with its variant".to_owned(),
        x,
        y,
        cells: Vec::new(),
        series,
        words,
    }
}

const COLOURS: [RGBColor; 6] =
    [colour::BLUE, colour::ORANGE, colour::GREEN, colour::PURPLE, colour::SKY, colour::YELLOW];

fn one(name: &str, colour: RGBColor, mark: Mark, points: Vec<(f64, f64)>) -> Series {
    Series { name: name.to_owned(), colour, mark, points }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "classifier,precision,window,lookback,accuracy,missed,false,shipped\n\
                         mlp,8,10/40,1,0.990,20,8,\n\
                         mlp,8,10/40,5,0.995,10,4,true\n\
                         mlp,float,10/40,1,0.990,19,9,\n\
                         logistic,8,10/40,1,0.940,100,68,\n\
                         svm,8,10/40,1,0.930,110,68,\n";

    fn costs() -> BTreeMap<String, u64> {
        let costs =
            [("features_10_40", 2_500), ("mlp_8_1", 3_500), ("mlp_8_5", 7_000), ("mlp_float_1", 9_600)];
        costs
            .iter()
            .chain(&[("logistic_8_1", 200), ("slow_frame", 9_100), ("structure", 500)])
            .map(|&(n, c)| (n.to_owned(), c))
            .collect()
    }

    #[test]
    fn scores_and_costs_are_joined_and_the_front_is_what_nothing_beats() {
        let chart = chart(TABLE, &costs()).unwrap();
        let mut rows = csv::Reader::from_reader(chart.csv.as_bytes());
        let rows: Vec<Vec<String>> =
            rows.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect();
        let found: Vec<_> = rows
            .iter()
            .map(|row| (row[0].as_str(), row[7].parse::<u64>().unwrap(), row[8] == "true"))
            .collect();
        assert_eq!(
            found,
            [
                ("logistic", 2_200, true),
                ("svm", 2_200, false),
                ("mlp", 5_500, true),
                // What is shipped costs what it costs whole.
                ("mlp", 9_100, true),
                ("mlp", 11_600, false),
            ]
        );
        for word in ["steps wrong", "1 % of 100 MHz", "shipped", "logistic"] {
            assert!(chart.svg.contains(word), "{word}");
        }
    }

    #[test]
    fn what_has_no_kernel_is_said_with_what_there_is() {
        let table = "classifier,precision,window,lookback,accuracy,missed,false\nforest,8,10/40,1,0.9,1,1\n";
        let error = format!("{:#}", chart(table, &costs()).unwrap_err());
        assert!(
            error.contains("line 2") && error.contains("forest_8_1") && error.contains("mlp_8_5"),
            "{error}"
        );
        let error = format!("{:#}", chart("classifier\nmlp\n", &costs()).unwrap_err());
        assert!(error.contains("precision"), "{error}");
        assert!(chart("classifier,precision,window,lookback,accuracy,missed,false\n", &costs()).is_err());
        let percent = TABLE.replace("0.990", "99.0");
        assert!(format!("{:#}", chart(&percent, &costs()).unwrap_err()).contains("part of all"));
    }
}
