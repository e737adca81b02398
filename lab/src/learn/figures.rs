//! The paper's figures 7 (c) and (d), 8 and 9 (Tada 2006), as ours.

use tenax_sim::plot::figure::colour;
use tenax_sim::plot::sheet::{Axis, Mark, Panel, Series, Sheet};

use super::Outcome;
use super::reflex::Three;
use super::trial::{Trial, Word};
use crate::chart::svg;

/// Fails if the sheet cannot be drawn.
pub fn draw(outcome: &Outcome) -> anyhow::Result<String> {
    let mut panels: Vec<Panel> = outcome.trials.first().map(beginning).into_iter().collect();
    panels.push(firsts(outcome));
    panels.push(sunk("8: the lift with the reflex", &outcome.lifts, 1.2));
    panels.push(sunk("9: the pour", &outcome.pours, 6.0));
    svg(&Sheet::new(
        "Network, vision and bound (Tada 2006, figures 7 c, 7 d, 8 and 9)",
        format!(
            "{} held-out trials, {} board, seed {}; lift and pour of one seed on the host's logic",
            outcome.score.trials, outcome.board, outcome.options.seed
        ),
        2,
        panels,
    ))
}

/// Figure 7 (c).
fn beginning(trial: &Trial) -> Panel {
    let since = |t_s: f64| t_s - trial.lift_s;
    let ticks = trial.outputs.iter().enumerate().step_by(4);
    let o1 = ticks.map(|(tick, outputs)| (since(Trial::time_s(tick)), f64::from(outputs[0]) / 128.0));
    // A code holds until the next one.
    let camera = &trial.truth.camera;
    let code = |n: usize| f64::from(camera[n].v1);
    let codes = (0..camera.len()).flat_map(|n| {
        let t_s = since(camera[n].arrives_s);
        [(t_s, code(n.saturating_sub(1))), (t_s, code(n))]
    });
    let mut all = vec![
        Series::new("network", colour::BLUE, Mark::Line, o1),
        Series::new("vision", colour::ORANGE, Mark::Line, codes),
    ];
    let upright = |t_s: f64| vec![(since(t_s), -1.2), (since(t_s), 1.2)];
    if let Some(up) = trial.slip_up() {
        all.push(Series::new("first place lets go", colour::GREEN, Mark::Dashes, upright(up.micro_onset_s)));
        all.push(Series::new("all of it slides", colour::PURPLE, Mark::Dashes, upright(up.macro_onset_s)));
    }
    for (name, colour, word) in
        [("slip said", colour::VERMILLION, Word::Slip), ("first word", colour::GREY, Word::Any)]
    {
        let said = trial.said_s(word).map(|t_s| (since(t_s), 0.0));
        all.push(Series::new(name, colour, Mark::Rings, said));
    }
    let x = Axis::even("time from the beginning of the lift, s", 0.0, 0.8);
    Panel::new("7 (c): o1 and v1 as the slip begins", x, Axis::even("o1, v1", -1.2, 1.2), all)
}

/// Figure 7 (d), each trial by itself.
fn firsts(outcome: &Outcome) -> Panel {
    let score = &outcome.score;
    let all = |times: &[f64]| times.iter().copied().map(Some).collect::<Vec<_>>();
    let series = [
        ("first word", colour::BLUE, Mark::Dots, score.first.said_s.clone()),
        ("slip said", colour::VERMILLION, Mark::Rings, score.slip.said_s.clone()),
        ("vision", colour::ORANGE, Mark::Dots, all(&score.vision_s)),
        ("first place lets go", colour::GREEN, Mark::Dashes, all(&score.micro_s)),
        ("all of it slides", colour::PURPLE, Mark::Dashes, all(&score.macro_s)),
    ];
    let series = series.map(|(name, colour, mark, times)| {
        let points = times.into_iter().enumerate().filter_map(|(n, t_s)| Some((n as f64 + 1.0, t_s?)));
        Series::new(name, colour, mark, points)
    });
    let x = Axis::even("trial", 0.0, score.trials as f64 + 1.0);
    Panel::new("7 (d): first report of slip", x, Axis::even("s from the lift", 0.0, 0.8), series.into())
}

/// Figures 8 and 9: the object's way in the hand, by the judge of the reflex.
fn sunk(title: &str, runs: &[Three], until_s: f64) -> Panel {
    let names = [("network", colour::BLUE), ("vision", colour::ORANGE), ("bound", colour::GREY)];
    let runs = runs.iter().take(1).flatten().zip(names);
    let series = runs.map(|(run, (name, colour))| {
        let points = run.sunk_mm.iter().copied().filter(|(t_s, _)| *t_s <= until_s);
        Series::new(name, colour, Mark::Line, points)
    });
    let all: Vec<Series> = series.collect();
    let most = all.iter().flat_map(|series| &series.points).map(|point| point.1).fold(1.0, f64::max);
    let x = Axis::even("time, s", 0.0, until_s);
    Panel::new(title, x, Axis::even("slipped, mm", 0.0, most * 1.05), all)
}
