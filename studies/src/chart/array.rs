//! The chart of `tenax chart array`: the network that ships against each quantity that the built-in data set draws.

use rayon::prelude::*;

use super::{Chart, Progress, csv};
use crate::dataset::session::{Sizes, sessions};
use crate::dataset::{Dataset, Plan};
use crate::evaluate::draws::{Draw, Part, draws};
use tenax_bench::array::network::Network;
use tenax_bench::array::real::Logits;
use tenax_bench::array::{Verdicts, readings};
use tenax_bench::labelled::{self, Part as Set, library};
use tenax_plot::figure::colour;
use tenax_plot::sheet::{Axis, Mark, Panel, Series, Sheet};

/// Judges the test part's pours, which nothing was chosen by, and draws what came of each quarter of their sessions.
/// Fails if a scene cannot be made or the chart not be drawn.
pub fn chart(progress: Progress) -> anyhow::Result<Chart> {
    let plan = Plan::default();
    let data = Dataset::make_split(plan, Set::Test, progress)?.csv()?;
    let name = "array_dataset.csv";
    let recordings = labelled::parse(data.as_slice(), &library::choose(name.as_ref(), None)?, name)?;
    let network = Network::shipped();
    let (logits, said): (Vec<Logits>, Vec<Verdicts>) =
        recordings.par_iter().map(|own| network.judge(&readings(&own.steps))).unzip();
    let drawn = sessions(plan.seed, Sizes::of_train(plan.sessions));
    of(&draws(&drawn, &recordings, &said, &logits))
}

fn of(draws: &[Draw]) -> anyhow::Result<Chart> {
    let header = "quantity,from,to,auc,balanced,caught_50ms,false_per_hour";
    let rows = draws.iter().flat_map(|draw| {
        draw.parts.iter().map(|part| {
            let caught = part.caught.map_or(String::new(), |caught| format!("{caught:.4}"));
            let numbers = [part.from, part.to, part.auc, part.balanced].map(|number| format!("{number:.4}"));
            let mut row = vec![draw.quantity.clone()];
            row.extend(numbers);
            row.extend([caught, format!("{:.1}", part.false_per_hour)]);
            row
        })
    });
    let csv = csv(header, rows)?;
    let sheet = Sheet::new(
        "Slip from normal force: where the network that ships fails",
        "Pours of the test part, material outside of the training's hull included. Each point is a quarter of the sessions; \
                   quantities in the order in which they matter.",
        4,
        draws.iter().map(panel).collect(),
    );
    Chart::new("array-draws", &sheet, csv)
}

fn panel(draw: &Draw) -> Panel {
    let least = draw.parts.iter().map(|part| part.from).fold(f64::INFINITY, f64::min);
    let most = draw.parts.iter().map(|part| part.to).fold(f64::NEG_INFINITY, f64::max);
    let log = least > 0.0;
    let x = if log {
        Axis::log(&draw.quantity, least / 1.1, most * 1.1)
    } else {
        Axis::even(&draw.quantity, least, most)
    };
    let middle = |part: &Part| {
        if log { (part.from * part.to).sqrt() } else { (part.from + part.to) / 2.0 }
    };
    let line = |of: &dyn Fn(&Part) -> Option<f64>| -> Vec<(f64, f64)> {
        draw.parts.iter().filter_map(|part| Some((middle(part), of(part)?))).collect()
    };
    let area = line(&|part| Some(part.auc));
    let balanced = line(&|part| Some(part.balanced));
    let caught = line(&|part| part.caught);
    Panel::new(
        draw.quantity.clone(),
        x,
        Axis::even("", 0.0, 1.0),
        vec![
            Series::new("area under ROC, a step", colour::BLUE, Mark::Line, area.clone()),
            Series::new("area under ROC, a step", colour::BLUE, Mark::Dots, area),
            Series::new("balanced accuracy as shipped", colour::ORANGE, Mark::Line, balanced),
            Series::new("slips caught within 50 ms as shipped", colour::VERMILLION, Mark::Dashes, caught),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_quantity_has_a_panel_and_each_quarter_a_row() {
        let part = |from: f64| Part {
            from,
            to: 2.0 * from,
            auc: 0.9,
            balanced: 0.7,
            caught: None,
            false_per_hour: 10.0,
        };
        let draw = |quantity: &str, from: f64| Draw {
            quantity: quantity.to_owned(),
            parts: vec![part(from), part(2.0 * from)],
            matters: 0.1,
        };
        let chart = of(&[draw("noise_mv", 0.2), draw("place_mm", -3.0)]).unwrap();
        assert_eq!(chart.csv.lines().count(), 5);
        assert!(chart.csv.contains("noise_mv,0.2000,0.4000,0.9000,0.7000,,10.0"));
        for word in ["noise_mv", "place_mm", "area under ROC"] {
            assert!(chart.svg.contains(word), "{word}");
        }
    }
}
