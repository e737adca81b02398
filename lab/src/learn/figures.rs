//! Figures 6 to 9 of the paper, as ours.

use plotters::style::RGBColor;
use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, PVDF_COUNT};
use tenax_hal_shim::wire::RECEPTORS;
use tenax_scene::plant::Plant;

use super::bench::{Bench, Judge};
use super::reflex::Three;
use super::report::Words;
use super::trial::{Setup, Trial, Word};
use super::{LESSONS, Outcome};
use tenax_sim::plot::draw;
use tenax_sim::plot::figure::{Curve, Figure, Panel, colour};
use tenax_sim::plot::sheet::{self, Axis, Mark, Series, Sheet, draw as sheets};
use tenax_sim::plot::thin::thin;

/// What the network was given in a trial.
#[derive(Clone, Debug, Default)]
pub struct Felt {
    /// How long the trial lasted, s.
    pub duration_s: f64,
    /// v1 and v2, when they came.
    pub codes: Vec<(f64, [i8; 2])>,
    /// Activations, 80 times a second.
    pub receptors: Vec<(f64, [f64; RECEPTORS])>,
}

impl Felt {
    /// Goes through a trial and records it.
    pub fn record(bench: &mut Bench, setup: Setup) -> (Trial, Self) {
        let mut trial = Trial { lift_s: setup.lift_s, ..Trial::default() };
        let mut felt = Self { duration_s: setup.world.duration_s(), ..Self::default() };
        let world = bench.run(setup.world, Judge::Touch, &mut |n, slow, bench| {
            trial.hear(n, slow, bench.said());
            let t_s = Trial::time_s((n + 1) * usize::from(FRAMES_PER_SLOW_FRAME));
            let activations = bench.network().activations.map(|t| f64::from(t) / f64::from(1 << 14));
            felt.receptors.push((t_s, activations));
        });
        trial.truth = world.truth().clone();
        felt.codes = trial.truth.camera.iter().map(|seen| (seen.arrives_s, [seen.v1, seen.v2])).collect();
        (trial, felt)
    }
}

/// A drawing and its name.
pub type Drawing = (&'static str, String);

/// All of them. Fails if one cannot be drawn.
pub fn draw_all(outcome: &Outcome) -> anyhow::Result<Vec<Drawing>> {
    let mut drawings = vec![("learn-receptors", draw::svg(&receptors(&outcome.felt))?)];
    if let Some(trial) = outcome.trials.first() {
        drawings.push(("learn-outputs", draw::svg(&outputs(trial))?));
    }
    drawings.push(("learn-worth", sheets::svg(&worth(outcome))?));
    Ok(drawings)
}

/// Between two words, the last one holds.
fn steps(points: impl IntoIterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut steps: Vec<(f64, f64)> = Vec::new();
    for (t_s, value) in points {
        if let Some(&(_, before)) = steps.last() {
            steps.push((t_s, before));
        }
        steps.push((t_s, value));
    }
    steps
}

fn panel(label: &str, at_least: (f64, f64), curves: Vec<Curve>) -> Panel {
    Panel { label: label.to_owned(), curves, at_least, height: 1.0, ..Panel::default() }
}

fn curve(name: &str, colour: RGBColor, points: Vec<(f64, f64)>) -> Curve {
    Curve { name: name.to_owned(), colour, points }
}

/// Figure 6: the codes, and two receptors of each kind, in three behaviours.
fn receptors(felt: &[Felt]) -> Figure {
    let mut begins_s = 0.0;
    let (mut codes, mut activations) = (Vec::new(), Vec::new());
    for trial in felt {
        codes.extend(trial.codes.iter().map(|(t_s, codes)| (begins_s + t_s, *codes)));
        activations.extend(trial.receptors.iter().map(|(t_s, felt)| (begins_s + t_s, *felt)));
        begins_s += trial.duration_s;
    }
    let code = |n: usize| steps(codes.iter().map(|(t_s, codes)| (*t_s, f64::from(codes[n]))));
    let receptor =
        |n: usize| -> Vec<(f64, f64)> { activations.iter().map(|(t, felt)| (*t, felt[n])).collect() };
    // The gauge that goes below 0 feels friction, the one that never does the grasp.
    let lowest = |n: usize| activations.iter().map(|(_, felt)| felt[n]).fold(0.0, f64::min);
    let gauges = PVDF_COUNT..RECEPTORS;
    let friction = gauges.clone().min_by(|&a, &b| lowest(a).total_cmp(&lowest(b))).unwrap_or(PVDF_COUNT);
    let grasp = gauges.max_by(|&a, &b| lowest(a).total_cmp(&lowest(b))).unwrap_or(PVDF_COUNT);
    let film = |n: usize| {
        panel(&format!("film {}", n + 1), (0.0, 1.0), vec![curve("activation", colour::BLUE, receptor(n))])
    };
    let gauge = |n: usize, what: &str| {
        let label = format!("gauge {}", n + 1 - PVDF_COUNT);
        panel(&label, (-1.0, 1.0), vec![curve(what, colour::GREEN, receptor(n))])
    };
    Figure {
        title: "What the fingertip learns from (Tada 2006, figure 6)".to_owned(),
        subtitle: format!("the last three of {LESSONS} trials; each receptor over its maximum"),
        span_s: (0.0, begins_s),
        slips: Vec::new(),
        panels: vec![
            panel("v1", (-1.0, 1.0), vec![curve("-1: slips", colour::VERMILLION, code(0))]),
            panel("v2", (-1.0, 1.0), vec![curve("1: up", colour::ORANGE, code(1))]),
            film(2),
            gauge(friction, "friction"),
            film(3),
            gauge(grasp, "grasp"),
        ],
    }
}

/// Figure 7 (a) to (c): what vision and the network say in a trial that was not learned from.
fn outputs(trial: &Trial) -> Figure {
    let span_s = (0.0, Trial::time_s(trial.outputs.len()));
    let slips = trial.truth.slips.iter();
    let slips = slips.map(|slip| (slip.micro_onset_s, slip.end_s.unwrap_or(span_s.1))).collect();
    let said = |n: usize| -> Vec<(f64, f64)> {
        let ticks = trial.outputs.iter().enumerate();
        ticks.map(|(tick, outputs)| (Trial::time_s(tick), f64::from(outputs[n]) / 128.0)).collect()
    };
    let seen = |n: usize| {
        let codes = trial.truth.camera.iter();
        steps(codes.map(|seen| (seen.arrives_s, f64::from([seen.v1, seen.v2][n]))))
    };
    let verdict = |word: Word| {
        let ticks = trial.said.iter().enumerate();
        let said = ticks.map(|(tick, &said)| (Trial::time_s(tick), f64::from(u8::from(word.is_in(said)))));
        thin(said, span_s)
    };
    let both = |label: &str, n: usize, v: &str, o: &str| {
        panel(
            label,
            (-1.0, 1.0),
            vec![
                curve(v, colour::ORANGE, thin(seen(n), span_s)),
                curve(o, colour::BLUE, thin(said(n), span_s)),
            ],
        )
    };
    Figure {
        title: "What vision and the network say (Tada 2006, figure 7 a and b)".to_owned(),
        subtitle: format!(
            "a held-out trial after {LESSONS} trials of learning; the lift begins at {:.2} s",
            trial.lift_s
        ),
        span_s,
        slips,
        panels: vec![
            both("-1: slips", 0, "vision, v1", "network, o1"),
            both("1: up, -1: down", 1, "vision, v2", "network, o2"),
            panel(
                "said",
                (0.0, 1.0),
                vec![
                    curve("slip", colour::VERMILLION, verdict(Word::Slip)),
                    curve("warning", colour::PURPLE, verdict(Word::Warning)),
                ],
            ),
        ],
    }
}

/// Figures 7 (c) and (d), 8 and 9.
fn worth(outcome: &Outcome) -> Sheet {
    let mut panels = Vec::new();
    panels.extend(outcome.trials.first().map(beginning));
    panels.push(firsts(outcome));
    panels.push(sunk("8: the lift with the reflex", &outcome.lifts, 1.2));
    panels.push(sunk("9: the pour", &outcome.pours, 6.0));
    Sheet::new(
        "What the network is worth (Tada 2006, figures 7 c, 7 d, 8 and 9)",
        format!(
            "{} held-out trials, {} board, seed {}; lift and pour of one seed on the host's logic",
            outcome.score.trials, outcome.board, outcome.options.seed
        ),
        2,
        panels,
    )
}

/// Figure 7 (c).
fn beginning(trial: &Trial) -> sheet::Panel {
    let since = |t_s: f64| t_s - trial.lift_s;
    let ticks = trial.outputs.iter().enumerate().step_by(4);
    let o1 = ticks.map(|(tick, outputs)| (since(Trial::time_s(tick)), f64::from(outputs[0]) / 128.0));
    let codes = trial.truth.camera.iter().map(|seen| (since(seen.arrives_s), f64::from(seen.v1)));
    let mut all = vec![
        Series::new("network", colour::BLUE, Mark::Line, o1),
        Series::new("vision", colour::ORANGE, Mark::Line, steps(codes)),
    ];
    let upright = |t_s: f64| vec![(since(t_s), -1.2), (since(t_s), 1.2)];
    if let Some([up, _]) = trial.both_slips() {
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
    sheet::Panel::new("7 (c): o1 and v1 as the slip begins", x, Axis::even("o1, v1", -1.2, 1.2), all)
}

/// Figure 7 (d), each trial by itself.
fn firsts(outcome: &Outcome) -> sheet::Panel {
    let score = &outcome.score;
    let dots = |name: &str, colour, mark, times: &[f64]| {
        let points = times.iter().enumerate().map(|(n, &t_s)| (n as f64 + 1.0, t_s));
        Series::new(name, colour, mark, points.filter(|(_, t_s)| t_s.is_finite()))
    };
    // A trial in which it was not said has no dot.
    let said_s = |words: &Words| -> Vec<f64> {
        words.said_s.iter().map(|said_s| said_s.unwrap_or(f64::NAN)).collect()
    };
    let x = Axis::even("trial", 0.0, score.trials as f64 + 1.0);
    let all = vec![
        dots("first word", colour::BLUE, Mark::Dots, &said_s(&score.first)),
        dots("slip said", colour::VERMILLION, Mark::Rings, &said_s(&score.slip)),
        dots("vision", colour::ORANGE, Mark::Dots, &score.vision_s),
        dots("first place lets go", colour::GREEN, Mark::Dashes, &score.micro_s),
        dots("all of it slides", colour::PURPLE, Mark::Dashes, &score.macro_s),
    ];
    sheet::Panel::new("7 (d): when slip was first said", x, Axis::even("s from the lift", 0.0, 0.8), all)
}

/// Figures 8 and 9: how far the object sinks in the hand, by who tells the reflex.
fn sunk(title: &str, runs: &[Three], until_s: f64) -> sheet::Panel {
    let names = [("network", colour::BLUE), ("vision", colour::ORANGE), ("bound", colour::GREY)];
    let all: Vec<Series> = runs
        .iter()
        .take(1)
        .flat_map(|three| three.iter().zip(names))
        .map(|(run, (name, colour))| {
            let points = run.sunk_mm.iter().copied().filter(|(t_s, _)| *t_s <= until_s);
            Series::new(name, colour, Mark::Line, points)
        })
        .collect();
    let most = all.iter().flat_map(|series| &series.points).map(|point| point.1).fold(1.0, f64::max);
    let x = Axis::even("time, s", 0.0, until_s);
    sheet::Panel::new(title, x, Axis::even("slipped, mm", 0.0, most * 1.05), all)
}
