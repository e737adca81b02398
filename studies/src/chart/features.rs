//! The chart of `tenax chart features`: Bamshad's selection of what a classifier should see (2023, section 4, figures 5
//! and 6), repeated on one pour of each seen material.
//!
//! The paper draws one number for each candidate and does not say which; here the covariance is the root of the mean
//! variance of an element's differences (the trace of equation 4 over window and elements), and the frequency the sum of
//! the magnitudes of all bins but the first.

use std::f64::consts::TAU;

use anyhow::Context;
use rayon::prelude::*;
use statrs::stats_tests::NaNPolicy;
use statrs::stats_tests::ks_test::{KSTwoSampleAlternativeMethod, ks_twosample};

use super::{Chart, Progress, csv};
use crate::dataset::collect::{Recording, record};
use crate::dataset::session::{Sizes, sessions};
use crate::dataset::story::Story;
use tenax_bench::jobs::Jobs;
use tenax_plot::figure::colour;
use tenax_plot::sheet::{Axis, Mark, Panel, Series, Sheet};

/// Steps a second.
const RATE_HZ: f64 = tenax_hal_shim::channel::SLOW_HZ as f64;
/// What is further from every slip than this is at rest, steps.
const FAR: usize = 80;
/// A candidate has decayed once it is below what this part of the steps at rest stays below.
const AT_REST: f64 = 0.95;

/// What a classifier could see of each step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Candidate {
    Sum,
    Derivative,
    /// Over so many differences.
    Covariance(usize),
    /// Over so many sums.
    Frequency(usize),
}

const CANDIDATES: [Candidate; 8] = [
    Candidate::Sum,
    Candidate::Derivative,
    Candidate::Covariance(1),
    Candidate::Covariance(5),
    Candidate::Covariance(10),
    Candidate::Frequency(10),
    Candidate::Frequency(20),
    Candidate::Frequency(40),
];

impl Candidate {
    const fn name(self) -> &'static str {
        match self {
            Self::Sum => "force sum",
            Self::Derivative => "force derivative",
            Self::Covariance(_) => "covariance",
            Self::Frequency(_) => "frequency",
        }
    }

    const fn window(self) -> usize {
        match self {
            Self::Sum => 1,
            Self::Derivative => 2,
            Self::Covariance(n) | Self::Frequency(n) => n,
        }
    }

    /// One number a step, samples; the first steps, whose window is not full, see what there is.
    fn of(self, recording: &Recording) -> Vec<f64> {
        let steps = &recording.steps;
        let sum = |at: usize| steps[at].samples.iter().map(|&sample| f64::from(sample)).sum::<f64>();
        let squares = |at: usize| {
            let before = &steps[at.saturating_sub(1)].samples;
            let change = steps[at].samples.iter().zip(before).map(|(&a, &b)| f64::from(a) - f64::from(b));
            change.map(|d| d * d).sum::<f64>() / before.len() as f64
        };
        let number = |at: usize| match self {
            Self::Sum => sum(at),
            Self::Derivative => (sum(at) - sum(at.saturating_sub(1))).abs(),
            Self::Covariance(n) => {
                let window = at.saturating_sub(n - 1)..=at;
                (window.clone().map(squares).sum::<f64>() / window.count() as f64).sqrt()
            }
            Self::Frequency(n) => {
                let window: Vec<f64> = (at.saturating_sub(n - 1)..=at).map(sum).collect();
                magnitudes(&window)
            }
        };
        (0..steps.len()).map(number).collect()
    }
}

/// The sum of the magnitudes of a transform's bins but the first, over their number.
fn magnitudes(window: &[f64]) -> f64 {
    let count = window.len();
    let bin = |k: usize| {
        let part = |wave: fn(f64) -> f64| -> f64 {
            let turn = |n: usize| TAU * (k * n % count) as f64 / count as f64;
            window.iter().enumerate().map(|(n, value)| value * wave(turn(n))).sum()
        };
        part(f64::cos).hypot(part(f64::sin)) / count as f64
    };
    (1..=count / 2).map(bin).sum::<f64>() / (count / 2).max(1) as f64
}

/// How well a candidate tells slip from rest.
struct Verdict {
    candidate: Candidate,
    /// The Kolmogorov-Smirnov statistic and its p-value.
    distance: f64,
    p_value: f64,
    /// Median time from a slip's last step until it is as at rest, ms.
    decay_ms: f64,
}

impl Verdict {
    fn of(candidate: Candidate, recordings: &[Recording]) -> anyhow::Result<Self> {
        let (mut slips, mut rests, mut decays) = (Vec::new(), Vec::new(), Vec::new());
        for recording in recordings {
            let numbers = candidate.of(recording);
            let at_rest: Vec<f64> =
                (0..numbers.len()).filter(|&at| far(recording, at)).map(|at| numbers[at]).collect();
            let below = quantile(at_rest, AT_REST);
            decays.extend(last_steps(recording).map(|last| {
                let after = numbers[last + 1..].iter().take_while(|&&number| number > below).count();
                after as f64 * 1e3 / RATE_HZ
            }));
            for (step, number) in recording.steps.iter().zip(numbers) {
                if step.slips { slips.push(number) } else { rests.push(number) }
            }
        }
        let test = KSTwoSampleAlternativeMethod::TwoSidedAsymptotic;
        let (distance, p_value) = ks_twosample(slips, rests, test, NaNPolicy::Error)
            .map_err(|error| anyhow::anyhow!("{error}"))
            .context("no slip to compare with, or no rest")?;
        Ok(Self { candidate, distance, p_value, decay_ms: quantile(decays, 0.5) })
    }
}

/// The last step of each slip that nothing follows within [`FAR`].
fn last_steps(recording: &Recording) -> impl Iterator<Item = usize> {
    let steps = &recording.steps;
    let ends = move |&at: &usize| {
        let after = &steps[at + 1..(at + 1 + FAR).min(steps.len())];
        steps[at].slips && after.len() == FAR && after.iter().all(|step| !step.slips)
    };
    (0..steps.len()).filter(ends)
}

fn far(recording: &Recording, at: usize) -> bool {
    let around = at.saturating_sub(FAR)..(at + FAR).min(recording.steps.len());
    // Not before the box is held.
    at as f64 > 3.5 * RATE_HZ && recording.steps[around].iter().all(|step| !step.slips)
}

fn quantile(mut values: Vec<f64>, part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let rank = (part * values.len() as f64) as usize;
    values.get(rank.min(values.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
}

/// Records the pours, tests every candidate and draws. Fails if a recording or the chart cannot be made.
pub fn chart(progress: Progress) -> anyhow::Result<Chart> {
    let first = Sizes { train: 1, validation: 0, test: 0 };
    let drawn = sessions(1, first);
    let jobs = Jobs::new(drawn.len() + CANDIDATES.len(), progress);
    let recordings: Vec<Recording> = drawn
        .par_iter()
        .map(|session| {
            let _job = jobs.begin();
            record(session, Story::Pour)
        })
        .collect::<Result<_, _>>()?;
    let verdicts: Vec<Verdict> = CANDIDATES
        .par_iter()
        .map(|&candidate| {
            let _job = jobs.begin();
            Verdict::of(candidate, &recordings)
        })
        .collect::<Result<_, _>>()?;
    let rows = verdicts.iter().map(|verdict| {
        vec![
            verdict.candidate.name().to_owned(),
            verdict.candidate.window().to_string(),
            format!("{:.3}", verdict.distance),
            format!("{:.2e}", verdict.p_value),
            format!("{:.1}", verdict.decay_ms),
        ]
    });
    let csv = csv(&["candidate", "window", "ks_distance", "p_value", "decay_ms"], rows)?;
    let shown = recordings.first().context("no recording")?;
    let told = |candidate: Candidate| {
        let verdict = verdicts.iter().find(|verdict| verdict.candidate == candidate);
        verdict
            .map_or(String::new(), |verdict| format!("{:.2}, p = {:.1e}", verdict.distance, verdict.p_value))
    };
    let [sum, derivative, .., covariance, _, _, frequency] = CANDIDATES;
    let mut panels: Vec<Panel> =
        [(sum, "samples"), (derivative, "samples"), (covariance, "samples"), (frequency, "samples")]
            .into_iter()
            .map(|(candidate, unit)| {
                let title = format!("{}: distance {}", candidate.name(), told(candidate));
                panel(title, unit, candidate == sum, by_label(shown, candidate))
            })
            .collect();
    for windows in [&CANDIDATES[2..5], &CANDIDATES[5..8]] {
        let title = format!("{}, by window", windows[0].name());
        let series =
            windows.iter().zip([colour::GREY, colour::SKY, colour::BLUE]).map(|(candidate, colour)| {
                let name = format!("{} over {}", candidate.name(), candidate.window());
                Series::new(name, colour, Mark::Line, points(shown, *candidate))
            });
        panels.push(panel(title, "samples", false, series.collect()));
    }
    let sheet = Sheet::new(
        "What tells slip from rest: Bamshad's figures 5 and 6 on the scenes' data",
        format!(
            "Drawn: {} of the data set's first session. Distances: Kolmogorov-Smirnov, slip against no slip, {} pours.",
            shown.story.name(),
            recordings.len()
        ),
        2,
        panels,
    );
    Chart::new("features", &sheet, csv)
}

fn points(recording: &Recording, candidate: Candidate) -> impl Iterator<Item = (f64, f64)> {
    recording.steps.iter().map(|step| step.t_s).zip(candidate.of(recording))
}

/// Steps that slip apart from those that do not.
fn by_label(recording: &Recording, candidate: Candidate) -> Vec<Series> {
    let kind = |slips: bool, name: &str, colour| {
        let own = points(recording, candidate).zip(&recording.steps).filter(|(_, step)| step.slips == slips);
        Series::new(name, colour, Mark::Dots, own.map(|(point, _)| point))
    };
    vec![kind(false, "no slip", colour::GREY), kind(true, "slip", colour::VERMILLION)]
}

fn panel(title: String, unit: &str, even: bool, series: Vec<Series>) -> Panel {
    let all = || series.iter().flat_map(|series| &series.points);
    let high = all().map(|point| point.1).fold(1.0, f64::max);
    let low = all().map(|point| point.1).filter(|y| *y > 0.0).fold(high, f64::min);
    let end_s = all().map(|point| point.0).fold(1.0, f64::max);
    let y = if even {
        Axis::even(unit, 0.95 * low, 1.02 * high)
    } else {
        Axis::log(unit, low.max(0.1), 1.5 * high)
    };
    Panel::new(title, Axis::even("time, s", 0.0, end_s), y, series)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::collect::Step;

    /// Two seconds of rest, one of slip, two of rest.
    fn made() -> Recording {
        let step = |at: usize| {
            let slips = (160..240).contains(&at);
            let shakes = if slips { 40 * (at % 2) as u16 } else { (at % 3) as u16 };
            let samples = std::array::from_fn(|n| 1_000 + shakes * (n % 2) as u16);
            Step { t_s: at as f64 / RATE_HZ, samples, slips, marker_slips: slips }
        };
        Recording {
            story: Story::Pour,
            steps: (0..400).map(step).collect(),
            spans: Vec::new(),
            slid_mm: 1.0,
            dropped: false,
        }
    }

    #[test]
    fn covariance_is_that_of_its_definition_and_a_longer_window_decays_later() {
        let recording = made();
        // Half of the elements change by 40: the mean square is 800.
        assert!((Candidate::Covariance(10).of(&recording)[200] - 800_f64.sqrt()).abs() < 1e-9);
        let decays = |n| {
            let numbers = Candidate::Covariance(n).of(&recording);
            numbers[240..].iter().take_while(|&&number| number > 5.0).count()
        };
        assert!(
            decays(1) < decays(5) && decays(5) < decays(10),
            "{} {} {}",
            decays(1),
            decays(5),
            decays(10)
        );
    }

    #[test]
    fn a_constant_has_no_frequency_and_a_tone_has_its_own() {
        assert!(magnitudes(&[7.0; 40]) < 1e-12);
        let tone: Vec<f64> = (0..40).map(|n| (TAU * 5.0 * f64::from(n) / 40.0).cos()).collect();
        assert!((magnitudes(&tone) * 20.0 - 0.5).abs() < 1e-9);
    }
}
