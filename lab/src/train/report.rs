//! What training found, for people and for programs.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde::Serialize;
use tenax_sim::array::edges::{Chosen, FALSE_2800_MAX, FALSE_PER_HOUR_MAX};
use tenax_logic::array::structure::STRUCTURES;

use crate::train::features::{Recipe, Sequence};
use crate::train::fit::Choice;
use crate::train::score::{Judged, Score, score};

/// The data that was learned and scored.
#[derive(Clone, Debug, Serialize)]
pub struct Data {
    pub file: String,
    /// SHA-256 of it.
    pub sha256: String,
    pub recordings: usize,
    /// Steps with features.
    pub steps: usize,
    pub slip_steps: usize,
    /// Sessions or objects.
    pub sessions: Vec<String>,
}

impl Data {
    /// Of a file's contents and what was made of them.
    pub fn of<'a>(file: &str, bytes: &[u8], sequences: impl IntoIterator<Item = &'a Sequence>) -> Self {
        use sha2::{Digest, Sha256};
        let sha256 = Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
            let _ = write!(text, "{byte:02x}");
            text
        });
        let (mut recordings, mut steps, mut slip_steps) = (0, 0, 0);
        let mut sessions: Vec<String> = Vec::new();
        for sequence in sequences {
            recordings += 1;
            steps += sequence.slips.len();
            slip_steps += sequence.slips.iter().filter(|&&slip| slip).count();
            if !sessions.contains(&sequence.session) {
                sessions.push(sequence.session.clone());
            }
        }
        Self { file: file.into(), sha256, recordings, steps, slip_steps, sessions }
    }
}

/// Scores on recordings that nothing was learned or chosen from.
#[derive(Clone, Debug, Serialize)]
pub struct Test {
    #[serde(flatten)]
    pub steps: Score,
    /// Missed steps in 2800.
    pub missed_per_2800: f64,
    /// False ones in 2800.
    pub false_per_2800: f64,
    /// Whole recordings, each by its mean logit; only where no recording both slips and does not.
    pub recordings: Option<Score>,
    /// By material or object.
    pub by_material: BTreeMap<String, Score>,
    pub by_session: BTreeMap<String, Score>,
}

impl Test {
    /// Of what was said of each sequence; slip is above the threshold.
    pub fn of(sequences: &[&Sequence], judged: &[Judged], threshold: f64) -> Self {
        let mut all = Judged::default();
        let mut whole = Some(Judged::default());
        let (mut by_material, mut by_session) = (BTreeMap::<_, Judged>::new(), BTreeMap::<_, Judged>::new());
        for (sequence, judged) in sequences.iter().zip(judged) {
            all.extend(judged);
            by_material.entry(sequence.material.clone()).or_default().extend(judged);
            by_session.entry(sequence.session.clone()).or_default().extend(judged);
            let one_kind = judged.slips.iter().all(|&slip| Some(&slip) == judged.slips.first());
            whole = whole.filter(|_| one_kind && !judged.slips.is_empty()).map(|mut whole| {
                whole.logits.push(judged.logits.iter().sum::<f64>() / judged.logits.len() as f64);
                whole.slips.push(judged.slips[0]);
                whole
            });
        }
        let steps = score(&all, threshold);
        let scores = |by: BTreeMap<String, Judged>| {
            by.into_iter().map(|(name, judged)| (name, score(&judged, threshold))).collect()
        };
        let per_2800 = |count: usize| 2_800.0 * count as f64 / steps.steps.max(1) as f64;
        Self {
            missed_per_2800: per_2800(steps.missed),
            false_per_2800: per_2800(steps.false_alarms),
            steps,
            recordings: whole.map(|whole| score(&whole, threshold)),
            by_material: scores(by_material),
            by_session: scores(by_session),
        }
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Seed of first weights and of the order of rows.
    pub seed: u64,
    /// What was learned.
    pub data: Data,
    /// What was scored, if it is another file.
    pub test_data: Option<Data>,
    pub features: Recipe,
    /// What was chosen, on sessions that it had not seen.
    pub choice: Choice,
    /// The threshold as a confidence, per mille.
    pub threshold_permille: u16,
    /// The edges of the verdict that is exported, if there were pours to choose them by.
    pub edges: Option<Chosen>,
    pub sizes: String,
    /// Scores on the pours of the validation part, which everything was chosen by, of the network that is exported.
    pub validation: Option<Test>,
    /// Scores in single precision.
    pub float: Option<Test>,
    /// Scores of the network that is exported: integers, the firmware's own arithmetic.
    pub quantised: Option<Test>,
    /// The same with weights of 16 bits.
    pub quantised_16: Option<Test>,
}

impl Report {
    /// Points of accuracy that 8 bits cost.
    pub fn lost_points(&self) -> Option<f64> {
        Some(100.0 * (self.float.as_ref()?.steps.accuracy - self.quantised.as_ref()?.steps.accuracy))
    }

    /// A model card, Markdown.
    pub fn card(&self) -> String {
        let mut text =
            String::from("# Model card: slip from ten normal forces\n\nWritten by `tenax train`.\n\n");
        let Data { file, sha256, recordings, steps, slip_steps, sessions } = &self.data;
        let choice = &self.choice;
        let _ = writeln!(text, "| | |\n|---|---|");
        let _ = writeln!(
            text,
            "| learned | `{file}`, SHA-256 `{sha256}`: {recordings} recordings of {} sessions or objects, {steps} steps, \
             {slip_steps} of them slip |",
            sessions.len()
        );
        if let Some(data) = &self.test_data {
            let _ = writeln!(
                text,
                "| scored | `{}`, SHA-256 `{}`: {} recordings of {} |",
                data.file,
                data.sha256,
                data.recordings,
                data.sessions.join(", ")
            );
        }
        let _ = writeln!(text, "| seed | {} |", self.seed);
        let Recipe { lag, window, spectrum, covariance_knee, spectrum_knee, structure_knee, .. } =
            self.features;
        let _ = writeln!(
            text,
            "| features | 55 covariances (lag {lag}, window {window}, knee {covariance_knee}), 21 spectral bins (window \
             {spectrum}, knee {spectrum_knee}), {STRUCTURES} structure functions (knee {structure_knee}) |"
        );
        let _ = writeln!(text, "| network | {}, 8-bit weights, 16-bit activations |", self.sizes);
        let _ = writeln!(
            text,
            "| chosen | {} passes ({}); balanced accuracy before rounding {:.2} % on sessions it had not seen |",
            choice.passes,
            if choice.candidate.warm { "begun as the logistic regression" } else { "from random weights" },
            100.0 * choice.unseen
        );
        let _ = writeln!(
            text,
            "| calibration | Platt scaling: log-odds = {:.4} logit {:+.4}; single threshold: confidence {} per mille |\n",
            choice.calibration.0, choice.calibration.1, self.threshold_permille
        );
        if let Some(validation) = &self.validation {
            let _ = writeln!(
                text,
                "## Pours of the validation part: what it was chosen by\n\n\
                 | | steps | missed | false | accuracy | balanced | AUC |\n|---|---|---|---|---|---|---|"
            );
            line(&mut text, "**exported**", &validation.steps);
            for (name, score) in &validation.by_material {
                line(&mut text, name, score);
            }
            let _ = writeln!(
                text,
                "\nIn 2800 steps {:.0} missed and {:.0} false.\n",
                validation.missed_per_2800, validation.false_per_2800
            );
        }
        if let Some(Chosen { edges, pour }) = &self.edges {
            let _ = writeln!(
                text,
                "**Shipped**: two thresholds. Slip begins at a confidence of {} and ends below {} per mille: the best balanced accuracy in \
                 these pours with at most {FALSE_PER_HOUR_MAX} false alarms an hour and {FALSE_2800_MAX} false steps in 2800. \
                 Result: balanced {:.3}; {:.0} steps missed and {:.0} false in 2800; {:.0} % of {} slips caught within 50 ms; \
                 {:.0} false alarms an hour.\n",
                edges.on_permille,
                edges.off_permille,
                pour.balanced,
                pour.missed_2800,
                pour.false_2800,
                100.0 * pour.caught_50ms.unwrap_or_default(),
                pour.slips,
                pour.false_per_hour
            );
        }
        if let (Some(float), Some(quantised)) = (&self.float, &self.quantised) {
            let _ = writeln!(
                text,
                "## Scores on recordings that nothing was learned or chosen from\n\n\
                 | | steps | missed | false | accuracy | balanced | AUC |\n|---|---|---|---|---|---|---|"
            );
            line(&mut text, "single precision", &float.steps);
            if let Some(wide) = &self.quantised_16 {
                line(&mut text, "16-bit weights", &wide.steps);
            }
            line(&mut text, "**exported**", &quantised.steps);
            if let Some(recordings) = &quantised.recordings {
                line(&mut text, "exported, whole recordings", recordings);
            }
            let worst_first = |by: &BTreeMap<String, Score>| {
                let mut all: Vec<(String, Score)> =
                    by.iter().map(|(name, score)| (name.clone(), *score)).collect();
                all.sort_by(|a, b| a.1.accuracy.total_cmp(&b.1.accuracy));
                all
            };
            for (name, score) in worst_first(&quantised.by_material) {
                line(&mut text, &name, &score);
            }
            if quantised.by_session.keys().ne(quantised.by_material.keys()) {
                for (name, score) in worst_first(&quantised.by_session) {
                    line(&mut text, &format!("session {name}"), &score);
                }
            }
            let _ = writeln!(
                text,
                "\nIn 2800 steps {:.0} missed and {:.0} false. \
                 Rounding to integers cost {:.2} points.",
                quantised.missed_per_2800,
                quantised.false_per_2800,
                self.lost_points().unwrap_or_default()
            );
        }
        let _ = writeln!(
            text,
            "\n## Limits\n\nIt knows the sensor, the materials and the ways of slipping that are in the data above, and no \
             others. It reports nothing in the first {} readings ({:.2} s). A report ends late, since its windows still hold the slip. \
             Confidence is calibrated for the data's share of slip.",
            self.features.ready_after() + self.choice.candidate.look_back - 1,
            (self.features.ready_after() + self.choice.candidate.look_back - 1) as f64 / 80.0
        );
        text
    }
}

fn line(text: &mut String, name: &str, score: &Score) {
    let _ = writeln!(
        text,
        "| {name} | {} | {} | {} | {:.2} % | {:.3} | {:.3} |",
        score.steps,
        score.missed,
        score.false_alarms,
        100.0 * score.accuracy,
        score.balanced,
        score.auc
    );
}
