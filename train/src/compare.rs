//! The paper's five classifiers on one data set (Bamshad 2023, section 5.1), and the perceptron's variants.

use std::fmt::Write;

use anyhow::ensure;
use tenax_bench::labelled::{Part, Recording};
use tenax_bench::scorer::Doing;
use tenax_logic::array::FEATURES;

use crate::features::{Recipe, Sequence, sequence};
use crate::fit::{self, Candidate};
use crate::linear::{Linear, logistic, svm};
use crate::network::{H1, H2};
use crate::quantise::Quantised;
use crate::recurrent::{self, Recurrent};
use crate::report::Test;
use crate::score::{Aim, Judged, threshold};
use crate::table::{Standard, Table};

/// Steps that the support vector machine learns from; its kernel matrix is as large as their square.
const SVM_ROWS: usize = 4_000;
/// The penalty of a squared weight of the logistic regression, a row.
const RIDGE: f64 = 1e-4;

/// Ways for a perceptron to learn a large data set with validation sessions: from random weights, quickly and slowly, and
/// from the logistic regression.
pub fn perceptrons(look_back: usize) -> [Candidate; 3] {
    let quick = Candidate {
        shyness: 1.0,
        ridge: RIDGE,
        warm: false,
        epochs: 12,
        learning_rate: 2e-3,
        decay: 1e-2,
        look_back,
    };
    let slow = Candidate { learning_rate: 4e-4, decay: 0.3, ..quick };
    [quick, slow, Candidate { shyness: 0.3, warm: true, ..slow }]
}

/// The way for a large data set to be shipped from: the first of [`perceptrons`], with all but variances and structure functions
/// scaled to a tenth, since the rest tells arrays apart sooner than sliding (`docs/training.md`).
pub fn shipped() -> [Candidate; 1] {
    let [quick, ..] = perceptrons(1);
    [Candidate { shyness: 0.1, ..quick }]
}

/// Ways to learn from a few objects: each begins as a logistic regression, and how far it leaves that is chosen on objects
/// that were left out.
pub const FEW_OBJECTS: [Candidate; 2] = [few(0.1), few(1.0)];

const fn few(shyness: f32) -> Candidate {
    Candidate { shyness, ridge: 4e-3, warm: true, epochs: 4, learning_rate: 3e-4, decay: 1e-1, look_back: 1 }
}

/// The layers' sizes, in words.
pub fn sizes(look_back: usize) -> String {
    match look_back {
        1 => format!("{FEATURES}-{H1}-{H2}-1"),
        frames => format!("{FEATURES}-{H1}-{H2}-1, of which the {H2} see {frames} frames of the {H1}"),
    }
}

/// A classifier's line.
#[derive(Clone, Debug)]
pub struct Line {
    /// Which, as `docs/figures/kernels.csv` names them.
    pub classifier: &'static str,
    /// `float`, or the bits of a weight.
    pub precision: &'static str,
    /// Differences in the covariance and sums in the spectrum.
    pub window: String,
    /// Frames seen at once.
    pub look_back: usize,
    /// Scores on the test part.
    pub test: Test,
}

/// Sequences by part.
struct Parts {
    all: Vec<Sequence>,
    window: String,
    /// What a perceptron is called that sees these features.
    perceptron: &'static str,
    aim: Aim,
}

/// Pours are the paper's task; where there is none, all steps are judged, both kinds alike.
fn aim(recordings: &[Recording]) -> Aim {
    if recordings.iter().any(|own| own.doing == Doing::Pour) { Aim::Pours } else { Aim::Balanced }
}

/// Recordings with parts: those of a file that names none are learned from, but for the last session, by which thresholds are
/// chosen; `tests` are what is scored then.
pub fn with_parts(mut recordings: Vec<Recording>, tests: Vec<Recording>) -> Vec<Recording> {
    if recordings.iter().all(|own| own.part.is_none()) {
        let last = recordings.iter().map(|own| own.session.clone()).max();
        for own in &mut recordings {
            own.part = Some(if Some(&own.session) == last.as_ref() { Part::Validation } else { Part::Train });
        }
    }
    recordings.extend(tests.into_iter().map(|own| Recording { part: Some(Part::Test), ..own }));
    recordings
}

impl Parts {
    fn of(recordings: &[Recording], recipe: &Recipe) -> Self {
        let aim = aim(recordings);
        // As the paper does: learned from pours and judged by them.
        let own = recordings.iter().filter(|own| aim != Aim::Pours || own.doing == Doing::Pour);
        Self {
            all: own.map(|recording| sequence(recording, recipe)).collect(),
            window: format!("{}/{}", recipe.window, recipe.spectrum),
            perceptron: if recipe.paper_only { "mlp" } else { "mlp-structure" },
            aim,
        }
    }

    fn part(&self, part: Part) -> Vec<&Sequence> {
        self.all.iter().filter(|sequence| sequence.part == Some(part)).collect()
    }

    /// Scores a classifier: threshold from the validation part, scores from the test part.
    fn line(
        &self,
        classifier: &'static str,
        precision: &'static str,
        look_back: usize,
        logits: &dyn Fn(&Sequence) -> anyhow::Result<Vec<f64>>,
    ) -> anyhow::Result<Line> {
        let judge = |sequence: &&Sequence| -> anyhow::Result<Judged> {
            let logits = logits(sequence)?;
            let slips = sequence.slips[sequence.slips.len() - logits.len()..].to_vec();
            Ok(Judged { logits, slips })
        };
        let mut all = Judged::default();
        for judged in self.part(Part::Validation).iter().map(judge) {
            all.extend(&judged?);
        }
        let tests = self.part(Part::Test);
        let judged: Vec<Judged> = tests.iter().map(judge).collect::<Result<_, _>>()?;
        let test = Test::of(&tests, &judged, threshold(&all, self.aim));
        Ok(Line { classifier, precision, window: self.window.clone(), look_back, test })
    }

    /// Ways to learn: of a large data set, and of a few objects.
    fn candidates(&self, look_back: usize) -> Vec<Candidate> {
        match self.aim {
            Aim::Pours => vec![Candidate { look_back, epochs: 4, ..perceptrons(look_back)[2] }],
            _ => FEW_OBJECTS.iter().map(|few| Candidate { look_back, ..*few }).collect(),
        }
    }

    fn perceptron(
        &self,
        look_back: usize,
        precisions: &[u32],
        seed: u64,
        progress: &mut dyn FnMut(f64),
    ) -> anyhow::Result<Vec<Line>> {
        let trained = fit::fit(&self.all, &self.candidates(look_back), self.aim, seed, progress)?;
        let learn = Table::of(self.part(Part::Train));
        let mut lines = Vec::new();
        for &bits in precisions {
            let quantised = Quantised::of(&trained.network, &learn, bits.min(16));
            lines.push(match bits {
                32 => self.line(self.perceptron, "float", look_back, &|sequence| {
                    Ok(trained.network.logits(&Table::of([sequence])))
                })?,
                16 => self.line(self.perceptron, "16", look_back, &|sequence| quantised.logits(sequence))?,
                _ => self.line(self.perceptron, "8", look_back, &|sequence| quantised.logits(sequence))?,
            });
        }
        Ok(lines)
    }
}

/// Trains the paper's five, the perceptron's variants, and the perceptron that sees structure functions too, on the training part, chooses thresholds on the validation part and scores on the test part.
/// Fails if the data set has not all three parts, or an optimiser fails.
pub fn compare(
    recordings: &[Recording],
    recipe: &Recipe,
    seed: u64,
    progress: &mut dyn FnMut(f64, &str),
) -> anyhow::Result<Vec<Line>> {
    // The paper's classifiers see what the paper shows them.
    let paper = Recipe { paper_only: true, ..*recipe };
    let parts = Parts::of(recordings, &paper);
    for part in Part::ALL {
        ensure!(!parts.part(part).is_empty(), "the comparison needs a {} part", part.name());
    }
    let learn = Table::of(parts.part(Part::Train));
    let aim = parts.aim;
    let standard = Standard::of(&learn, if aim == Aim::Pours { 1.0 } else { FEW_OBJECTS[0].shyness });
    let each = |sequence: &Sequence, linear: &Linear| -> Vec<f64> {
        let table = Table::of([sequence]);
        (0..table.len()).map(|row| linear.logit(table.row(row))).collect()
    };
    let mut lines = Vec::new();
    progress(0.0, "SVM");
    let machine = svm(&learn, &standard, SVM_ROWS, seed)?;
    lines.push(parts.line("svm", "float", 1, &|sequence| Ok(each(sequence, &machine)))?);
    progress(0.1, "logistic regression");
    let ridge = if aim == Aim::Pours { RIDGE } else { FEW_OBJECTS[0].ridge };
    let linear = logistic(&learn, &standard, ridge, aim == Aim::Balanced)?;
    lines.push(parts.line("logistic", "float", 1, &|sequence| Ok(each(sequence, &linear)))?);
    for (autoencoder, name, from, share) in
        [(true, "lstm-autoencoder", 0.15, 0.35), (false, "lstm", 0.5, 0.2)]
    {
        let settings = recurrent::Settings { autoencoder, epochs: 8, sequences: 20_000, seed };
        let detector =
            Recurrent::fit(&learn, &standard, settings, &mut |part| progress(from + share * part, name))?;
        lines.push(parts.line(name, "float", 1, &|sequence| detector.logits(&Table::of([sequence])))?);
    }
    lines.extend(parts.perceptron(1, &[32, 16, 8], seed, &mut |part| progress(0.7 + 0.05 * part, "MLP"))?);
    lines.extend(parts.perceptron(3, &[8], seed, &mut |part| progress(0.75 + 0.05 * part, "MLP"))?);
    lines.extend(parts.perceptron(5, &[32, 8], seed, &mut |part| progress(0.8 + 0.06 * part, "MLP"))?);
    // A sensor that asks for a longer window has no use for figure 6's shorter ones.
    let shorter: &[(usize, usize)] =
        if recipe.window == Recipe::FIRMWARE.window { &[(5, 20), (1, 10)] } else { &[] };
    for (n, &(window, spectrum)) in shorter.iter().enumerate() {
        let parts = Parts::of(recordings, &Recipe { window, spectrum, ..paper });
        let from = 0.86 + 0.04 * n as f64;
        lines.extend(parts.perceptron(1, &[8], seed, &mut |part| progress(from + 0.04 * part, "MLP"))?);
    }
    let parts = Parts::of(recordings, &Recipe { paper_only: false, ..*recipe });
    let what = "MLP with structure functions";
    lines.extend(parts.perceptron(1, &[32, 16, 8], seed, &mut |part| progress(0.94 + 0.06 * part, what))?);
    Ok(lines)
}

/// The table as CSV, for the chart.
pub fn csv(lines: &[Line]) -> String {
    let mut text =
        String::from("classifier,precision,window,lookback,balanced,auc,accuracy,missed,false,shipped\n");
    for Line { classifier, precision, window, look_back, test } in lines {
        let _ = writeln!(
            text,
            "{classifier},{precision},{window},{look_back},{:.5},{:.5},{:.5},{},{},",
            test.steps.balanced,
            test.steps.auc,
            test.steps.accuracy,
            test.steps.missed,
            test.steps.false_alarms,
        );
    }
    text
}

/// The table for people.
pub fn text(lines: &[Line]) -> String {
    let mut text = format!(
        "{:<18}{:>6}{:>8}{:>8}{:>10}{:>10}{:>8}{:>8}{:>8}  balanced by material\n",
        "classifier", "bits", "window", "frames", "balanced", "accuracy", "missed", "false", "AUC"
    );
    for Line { classifier, precision, window, look_back, test } in lines {
        let mut materials: Vec<_> = test.by_material.iter().collect();
        materials.sort_by(|a, b| a.1.balanced.total_cmp(&b.1.balanced));
        let materials: Vec<String> =
            materials.iter().map(|(name, score)| format!("{name} {:.3}", score.balanced)).collect();
        let _ = writeln!(
            text,
            "{classifier:<18}{precision:>6}{window:>8}{look_back:>8}{:>10.3}{:>9.2}%{:>8.0}{:>8.0}{:>8.3}  {}",
            test.steps.balanced,
            100.0 * test.steps.accuracy,
            test.missed_per_2800,
            test.false_per_2800,
            test.steps.auc,
            materials.join(", ")
        );
    }
    text.push_str("pours, where there are any; missed and false in 2800 steps\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_without_parts_is_learned_from_but_for_its_last_session() {
        let own = |session: &str| Recording {
            session: session.to_owned(),
            ..Recording::of_steps(session, Vec::new())
        };
        let parted = with_parts(vec![own("b"), own("a"), own("b")], vec![own("c")]);
        let parts: Vec<Option<Part>> = parted.iter().map(|own| own.part).collect();
        assert_eq!(parts, [Part::Validation, Part::Train, Part::Validation, Part::Test].map(Some));
        // The control: parts that a file has are kept.
        let named = Recording { part: Some(Part::Train), ..own("z") };
        assert_eq!(with_parts(vec![named, own("a")], Vec::new())[0].part, Some(Part::Train));
    }
}
