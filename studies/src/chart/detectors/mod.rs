//! The chart of `tenax chart detectors`: what each classifier gets right for the instructions that it takes.

mod table;

use std::collections::BTreeMap;

use anyhow::Result;
use plotters::style::RGBColor;

use self::table::{Measured, Row};
use super::{Chart, csv};
use tenax_plot::figure::colour;
use tenax_plot::sheet::draw::INK;
use tenax_plot::sheet::{Axis, Mark, Panel, Series, Sheet};

/// A hundredth of what the core executes in a slow frame, at 100 MHz and one instruction a cycle.
const LOAD_BAR: f64 = 12_500.0;
/// Balanced accuracy that an axis has above its best and below its worst.
const MARGIN: f64 = 0.02;

/// Joins tables of scores (of which data, and CSV, as [`Row`] describes it) with the instructions that each kernel took (CSV:
/// kernel,instructions), and draws them side by side. An error says which line of the table is wrong, or has no kernel.
pub fn chart(tables: &[(&str, &str)], kernels: &str) -> Result<Chart> {
    let instructions: BTreeMap<String, u64> =
        csv::Reader::from_reader(kernels.as_bytes()).deserialize().collect::<Result<_, _>>()?;
    let (mut rows, mut panels) = (Vec::new(), Vec::new());
    for (data, table) in tables {
        let mut all = table::read(table, &instructions)?;
        all.sort_by(|a, b| {
            a.instructions.cmp(&b.instructions).then(b.row.balanced.total_cmp(&a.row.balanced))
        });
        let front = front(&all);
        rows.extend(all.iter().enumerate().map(|(n, measured)| {
            let Row {
                classifier,
                precision,
                window,
                lookback,
                balanced,
                accuracy,
                missed,
                false_alarms,
                shipped,
            } = &measured.row;
            let words = [*data, classifier, precision, window].map(str::to_owned);
            let parts = [balanced, accuracy].map(|part| format!("{part:.5}"));
            let counts = [missed, false_alarms, &measured.instructions].map(u64::to_string);
            let marks = [front.contains(&n), *shipped].map(|mark| mark.to_string());
            let all = words.into_iter().chain([lookback.to_string()]).chain(parts).chain(counts).chain(marks);
            all.collect()
        }));
        panels.push(panel(data, &all, &front));
    }
    let header = [
        "data",
        "classifier",
        "precision",
        "window",
        "lookback",
        "balanced",
        "accuracy",
        "missed",
        "false",
        "instructions",
        "front",
        "shipped",
    ];
    let csv = csv(&header, rows)?;
    let sheet = Sheet::new(
        "Slip from normal force alone: what it gets right against what it takes",
        "Sessions and objects never seen. Instructions of one slow frame (12.5 ms), features included, counted on the \
                   emulated Cortex-M4.",
        panels.len() as u32,
        panels,
    );
    Chart::new("detectors-cost", &sheet, csv)
}

/// Of points by rising cost: those that nothing as cheap is better than.
fn front(all: &[Measured]) -> Vec<usize> {
    let mut best = f64::NEG_INFINITY;
    let mut front = Vec::new();
    for (n, measured) in all.iter().enumerate() {
        if measured.row.balanced > best {
            best = measured.row.balanced;
            front.push(n);
        }
    }
    front
}

fn panel(data: &str, all: &[Measured], front: &[usize]) -> Panel {
    let at = |measured: &Measured| (measured.instructions as f64, measured.row.balanced);
    let points: Vec<_> = all.iter().map(at).collect();
    let ends = |pick: fn(&(f64, f64)) -> f64| {
        let values = points.iter().map(pick);
        (values.clone().fold(f64::INFINITY, f64::min), values.fold(0.0, f64::max))
    };
    let (cheapest, dearest) = ends(|point| point.0);
    let (worst, best) = ends(|point| point.1);
    let y = Axis::even("balanced accuracy", (worst - MARGIN).max(0.0), (best + MARGIN).min(1.0));
    let decades = |from: f64, to: f64| (10_f64.powf(from.log10().floor()), 10_f64.powf(to.log10().ceil()));
    let (from, to) = decades(cheapest / 1.2, dearest.max(LOAD_BAR) * 1.2);
    let x = Axis::log("instructions a slow frame", from, to);

    let mut names: Vec<&str> = all.iter().map(|measured| measured.row.classifier.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let mut series: Vec<Series> = names
        .iter()
        .zip(COLOURS.iter().cycle())
        .map(|(name, &colour)| {
            let own = all.iter().filter(|measured| measured.row.classifier == *name).map(at);
            Series::new(*name, colour, Mark::Dots, own)
        })
        .collect();
    series.push(Series::new("front", INK, Mark::Dashes, front.iter().map(|&n| points[n])));
    let bar = vec![(LOAD_BAR, y.ends.0), (LOAD_BAR, y.ends.1)];
    series.push(Series::new("1 % of 100 MHz", colour::GREY, Mark::Line, bar));
    let shipped = all.iter().filter(|measured| measured.row.shipped).map(at);
    series.push(Series::new("shipped", colour::VERMILLION, Mark::Rings, shipped));
    Panel::new(format!("{data}: each dot is a variant of a classifier"), x, y, series)
}

const COLOURS: [RGBColor; 6] =
    [colour::BLUE, colour::ORANGE, colour::GREEN, colour::PURPLE, colour::SKY, colour::YELLOW];

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "classifier,precision,window,lookback,balanced,accuracy,missed,false,shipped\n\
                         mlp,8,10/40,1,0.990,0.990,20,8,\n\
                         mlp,8,10/40,5,0.995,0.995,10,4,true\n\
                         mlp,float,10/40,1,0.990,0.990,19,9,\n\
                         logistic,8,10/40,1,0.940,0.940,100,68,\n\
                         svm,8,10/40,1,0.930,0.930,110,68,\n";

    const KERNELS: &str = "kernel,instructions\nfeatures_10_40,2500\nmlp_8_1,3500\nmlp_8_5,7000\nmlp_float_1,9600\n\
                           logistic_8_1,200\nslow_frame,9100\nstructure,500\n";

    #[test]
    fn scores_and_costs_are_joined_and_the_front_is_what_nothing_beats() {
        let chart = chart(&[("pours", TABLE)], KERNELS).unwrap();
        let mut rows = csv::Reader::from_reader(chart.csv.as_bytes());
        let rows: Vec<Vec<String>> =
            rows.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect();
        let found: Vec<_> = rows
            .iter()
            .map(|row| (row[1].as_str(), row[9].parse::<u64>().unwrap(), row[10] == "true"))
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
        for word in ["balanced accuracy", "1 % of 100 MHz", "shipped", "logistic"] {
            assert!(chart.svg.contains(word), "{word}");
        }
    }

    #[test]
    fn what_has_no_kernel_is_said_with_what_there_is() {
        let table = "classifier,precision,window,lookback,balanced,accuracy,missed,false\nforest,8,10/40,1,0.9,0.9,1,1\n";
        let error = format!("{:#}", chart(&[("pours", table)], KERNELS).unwrap_err());
        assert!(
            error.contains("line 2") && error.contains("forest_8_1") && error.contains("mlp_8_5"),
            "{error}"
        );
        let error = format!("{:#}", chart(&[("pours", "classifier\nmlp\n")], KERNELS).unwrap_err());
        assert!(error.contains("precision"), "{error}");
        assert!(
            chart(
                &[("pours", "classifier,precision,window,lookback,balanced,accuracy,missed,false\n")],
                KERNELS
            )
            .is_err()
        );
        let percent = TABLE.replace("0.990", "99.0");
        assert!(format!("{:#}", chart(&[("pours", &percent)], KERNELS).unwrap_err()).contains("part of all"));
    }
}
