//! `tenax chart emg`: speed and accuracy of what the wearer wants, on recorded people.

use std::path::Path;

use tenax_sim::plot::colour;
use tenax_sim::plot::sheet::{Axis, Mark, Panel, Series, Sheet};

use super::{Chart, csv};
use crate::evaluate::emg::curves::{self, Point};

const LEAST_PER_HOUR: f64 = 1.0;

/// Plays everybody in a folder with the hand and with plain control, each asking for more and for less. Fails if nobody is there.
pub fn chart(folder: &Path) -> anyhow::Result<Chart> {
    let points = curves::curves(folder)?;
    let rows = points.iter().map(|point| {
        let words = [point.control, point.calibration].map(str::to_owned);
        words.into_iter().chain(numbers(point).map(|number| format!("{number:.4}"))).collect()
    });
    let header =
        "control,calibration,asks,false_per_hour,right,repetitions_right,latency_p50_s,latency_p95_s";
    let csv = csv(header, rows)?;
    let right = |point: &Point| point.right();
    let repetitions = |point: &Point| point.score.repetitions_right;
    let late = |point: &Point| point.score.latency_s_p95;
    let panels = ["same session", "other posture"]
        .into_iter()
        .flat_map(|calibration| {
            let own: Vec<&Point> = points.iter().filter(|point| point.calibration == calibration).collect();
            [
                panel(calibration, Axis::even("windows right", 0.5, 1.0), &own, &right),
                panel(calibration, Axis::even("repetitions right", 0.3, 1.0), &own, &repetitions),
                panel(calibration, Axis::even("label to wish, p95, s", 0.0, 2.0), &own, &late),
            ]
        })
        .collect();
    let sheet = Sheet::new(
        "What the wearer wants: the hand and plain two-site control",
        "each asks for more or less of the calibrated contraction; all people and sessions together; none an hour is drawn at 1",
        3,
        panels,
    );
    Chart::new("emg", &sheet, csv)
}

fn numbers(point: &Point) -> [f64; 6] {
    let score = &point.score;
    let right = [point.right(), score.repetitions_right];
    [point.asks, score.false_per_hour, right[0], right[1], score.latency_s_p50, score.latency_s_p95]
}

fn panel(title: &str, y: Axis, points: &[&Point], value: &dyn Fn(&Point) -> f64) -> Panel {
    let of = |is_one: &dyn Fn(&Point) -> bool| -> Vec<(f64, f64)> {
        let own = points.iter().filter(|point| is_one(point));
        own.map(|point| (point.score.false_per_hour.max(LEAST_PER_HOUR), value(point))).collect()
    };
    let series = vec![
        Series::new("plain control", colour::GREY, Mark::Line, of(&|point| point.control == "plain")),
        Series::new("the hand", colour::VERMILLION, Mark::Line, of(&|point| point.control == "hand")),
        Series::new("the hand as it ships", colour::VERMILLION, Mark::Dots, of(&Point::ships)),
    ];
    Panel::new(title, Axis::log("false motions an hour of rest", LEAST_PER_HOUR, 2_000.0), y, series)
}
