//! The chart of `tenax chart onset`: how soon anybody could tell the slip of a lift, and from what.

use super::{Chart, Progress, csv};
use crate::learn::observer::{self, Bound, CERTAIN, SENSES, Watched};
use tenax_plot::figure::colour;
use tenax_plot::sheet::{Axis, Mark, Panel, Series, Sheet};

/// Seeds of `tenax learn`, fingers made by chance of each, trials of each finger.
const SEEDS: [u64; 3] = [1, 2, 3];
const FINGERTIPS: u64 = 20;
const TRIALS: u64 = 10;
/// Where sliding keeps at most so much of static friction.
const SLIPPERY: f64 = 0.75;
/// What is asked of the two groups, s, with the camera's delay and without.
const ASKED_S: [[f64; 2]; 2] = [[0.30, 0.24], [0.15, 0.15]];

/// Whether a finger is in a group.
type IsIn = fn(&Bound) -> bool;

#[derive(Clone, Debug)]
pub struct Measured(Vec<Bound>);

impl std::fmt::Display for Measured {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(
            f,
            "lead over the camera, s: mean of the fingers, and of the worst one; in brackets over a camera without delay"
        )?;
        let groups: [(&str, IsIn); 3] = [
            ("plain fingers", |bound| bound.finger[1] == 0),
            ("ratio to 0.75", |bound| bound.finger[1] > 0 && bound.ratio <= SLIPPERY),
            ("ratio above", |bound| bound.finger[1] > 0 && bound.ratio > SLIPPERY),
        ];
        for (group, is_in) in groups {
            let bounds: Vec<&Bound> = self.0.iter().filter(|bound| is_in(bound)).collect();
            writeln!(f, "  {group}, {}", bounds.len())?;
            let mut line = |what: &str, of: &dyn Fn(&Bound) -> [f64; 2]| {
                let mean = |delay: usize| {
                    bounds.iter().map(|bound| of(bound)[delay]).sum::<f64>() / bounds.len().max(1) as f64
                };
                let worst = bounds.iter().map(|bound| of(bound)[0]).fold(f64::INFINITY, f64::min);
                writeln!(f, "    {what:<24}{:.3} ({:.3}), worst {worst:.3}", mean(0), mean(1))
            };
            line("the first place lets go", &|bound| bound.first_place_s)?;
            for (n, sense) in SENSES.into_iter().enumerate() {
                line(&format!("certain: {sense}"), &|bound| bound.certain_s[n])?;
            }
            line("all of it slides", &|bound| bound.macro_s)?;
        }
        Ok(())
    }
}

/// Measures and draws it. Fails if a scene cannot be made, or the chart cannot be drawn.
pub fn chart(progress: Progress) -> anyhow::Result<(Chart, Measured)> {
    let (mut bounds, mut plain) = (Vec::new(), Vec::new());
    for (n, seed) in SEEDS.into_iter().enumerate() {
        let (more, watched) = observer::bounds(seed, FINGERTIPS, TRIALS)?;
        bounds.extend(more);
        plain.extend(watched);
        progress((n + 1) as f64 / SEEDS.len() as f64);
    }
    let rows = bounds.iter().map(|bound| {
        let leads = [bound.first_place_s, bound.macro_s].into_iter().chain(bound.certain_s);
        let numbers = leads.flatten().map(|lead_s| format!("{lead_s:.4}"));
        [bound.finger[0].to_string(), bound.finger[1].to_string(), format!("{:.3}", bound.ratio)]
            .into_iter()
            .chain(numbers)
            .collect()
    });
    let mut header = vec!["seed", "finger", "ratio"];
    header.extend([
        "first_s",
        "first_no_delay_s",
        "macro_s",
        "macro_no_delay_s",
        "films_s",
        "films_no_delay_s",
    ]);
    header.extend([
        "gauges_s",
        "gauges_no_delay_s",
        "force_s",
        "force_no_delay_s",
        "all_s",
        "all_no_delay_s",
    ]);
    let csv = csv(&header, rows)?;
    let sheet = Sheet::new(
        "How soon anybody could tell the slip of a lift",
        format!(
            "observers that know every voltage in advance, wrong once in 3 h; seeds 1 to 3, {FINGERTIPS} fingers each"
        ),
        2,
        vec![rising(plain.first()), leads(&bounds)],
    );
    Ok((Chart::new("onset", &sheet, csv)?, Measured(bounds)))
}

const COLOURS: [plotters::style::RGBColor; SENSES.len()] =
    [colour::BLUE, colour::GREEN, colour::ORANGE, colour::GREY];

/// d' over time, in one trial of the plain finger.
fn rising(trial: Option<&Watched>) -> Panel {
    let mut all = Vec::new();
    if let Some(trial) = trial {
        for (n, (sense, colour)) in SENSES.into_iter().zip(COLOURS).enumerate() {
            let points = trial.rising.iter().map(|(t_s, told)| (*t_s, told[n].max(0.01)));
            all.push(Series::new(sense, colour, Mark::Line, points));
        }
        let upright = |t_s: f64| vec![(t_s, 0.01), (t_s, 1_000.0)];
        all.push(Series::new("first place lets go", colour::PURPLE, Mark::Dashes, upright(trial.micro_s)));
        all.push(Series::new("all of it slides", colour::VERMILLION, Mark::Dashes, upright(trial.macro_s)));
        all.push(Series::new("certain", colour::GREY, Mark::Dashes, vec![(0.0, CERTAIN), (0.5, CERTAIN)]));
    }
    Panel::new(
        "what the pins tell of it, one trial of the plain finger",
        Axis::even("time from the beginning of the lift, s", 0.0, 0.5),
        Axis::log("d'", 0.01, 1_000.0),
        all,
    )
}

/// Each finger's bounds on the lead, over what sliding keeps of its friction.
fn leads(bounds: &[Bound]) -> Panel {
    let dots = |of: &dyn Fn(&Bound) -> [f64; 2]| {
        bounds.iter().map(|bound| (bound.ratio, of(bound)[0])).collect::<Vec<_>>()
    };
    let mut all = vec![
        Series::new("first place lets go", colour::PURPLE, Mark::Rings, dots(&|bound| bound.first_place_s)),
        Series::new("all of it slides", colour::VERMILLION, Mark::Crosses, dots(&|bound| bound.macro_s)),
    ];
    all.push(Series::new(SENSES[0], COLOURS[0], Mark::Dots, dots(&|bound| bound.certain_s[0])));
    let asked = ASKED_S.map(|asked_s| asked_s[0]);
    all.push(Series::new(
        "asked for",
        colour::GREY,
        Mark::Line,
        vec![(0.6, asked[0]), (SLIPPERY, asked[0]), (SLIPPERY, asked[1]), (0.95, asked[1])],
    ));
    Panel::new(
        "lead over a camera with 53 ms of delay, each finger",
        Axis::even("what sliding keeps of static friction", 0.58, 0.97),
        Axis::even("lead, s", -0.1, 0.6),
        all,
    )
}
