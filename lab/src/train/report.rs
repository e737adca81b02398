//! Data, choice and validation scores of a training, for people and for programs.

use std::collections::BTreeSet;
use std::fmt::Write;

use serde::Serialize;
use tenax_logic::array::FEATURES;
use tenax_logic::array::structure::STRUCTURES;
use tenax_sim::array::edges::{Chosen, FALSE_2800_MAX, FALSE_PER_HOUR_MAX};

use crate::dataset::sha256;
use crate::train::features::{Recipe, Sequence};
use crate::train::fit::Choice;
use crate::train::network::{H1, H2};
use crate::train::score::Score;

#[derive(Clone, Debug, Serialize)]
pub struct Data {
    pub file: String,
    pub sha256: String,
    pub recordings: usize,
    pub steps: usize,
    pub slip_steps: usize,
    pub sessions: usize,
}

impl Data {
    pub fn of(file: &str, bytes: &[u8], sequences: &[&Sequence]) -> Self {
        let slips = || sequences.iter().flat_map(|own| &own.slips);
        let sessions: BTreeSet<_> = sequences.iter().map(|own| &own.session).collect();
        Self {
            file: file.into(),
            sha256: sha256(bytes),
            recordings: sequences.len(),
            steps: slips().count(),
            slip_steps: slips().filter(|&&slip| slip).count(),
            sessions: sessions.len(),
        }
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Seed of the first weights and of the order of rows.
    pub seed: u64,
    pub data: Data,
    pub features: Recipe,
    pub choice: Choice,
    /// The threshold as a confidence, per mille.
    pub threshold_permille: u16,
    /// The edges of the exported verdict, if there were pours to choose them by.
    pub edges: Option<Chosen>,
    /// On the pours of the validation part, in single precision and of the exported integers. None without pours.
    pub float: Option<Score>,
    pub exported: Option<Score>,
}

impl Report {
    /// A model card, Markdown.
    pub fn card(&self) -> String {
        let Data { file, sha256, recordings, steps, slip_steps, sessions } = &self.data;
        let Recipe { lag, window, spectrum, covariance_knee, spectrum_knee, structure_knee } = self.features;
        let choice = &self.choice;
        let mut text = format!(
            "# Model card: slip from ten normal forces\n\nWritten by `tenax train`.\n\n| | |\n|---|---|\n\
             | learned | `{file}`, SHA-256 `{sha256}`: {recordings} recordings of {sessions} sessions or objects, {steps} steps, \
             {slip_steps} of them slip |\n\
             | seed | {} |\n\
             | features | 55 covariances (lag {lag}, window {window}, knee {covariance_knee}), 21 spectral bins (window {spectrum}, knee \
             {spectrum_knee}), {STRUCTURES} structure functions (knee {structure_knee}) |\n\
             | network | {FEATURES}-{H1}-{H2}-1, 8-bit weights, 16-bit activations |\n\
             | chosen | {} passes ({}); balanced accuracy before rounding {:.2} % on sessions it had not seen |\n\
             | calibration | Platt scaling: log-odds = {:.4} logit {:+.4}; single threshold: confidence {} per mille |\n\n",
            self.seed,
            choice.passes,
            if choice.candidate.warm { "begun as the logistic regression" } else { "from random weights" },
            100.0 * choice.unseen,
            choice.calibration.0,
            choice.calibration.1,
            self.threshold_permille
        );
        if let (Some(float), Some(exported)) = (&self.float, &self.exported) {
            text += "## Pours of the validation part\n\n| | steps | missed | false | accuracy | balanced | AUC |\n|---|---|---|---|---|---|---|\n";
            for (name, score) in [("single precision", float), ("**exported**", exported)] {
                let Score { steps, missed, false_alarms, accuracy, balanced, auc } = score;
                let _ = writeln!(
                    text,
                    "| {name} | {steps} | {missed} | {false_alarms} | {:.2} % | {balanced:.3} | {auc:.3} |",
                    100.0 * accuracy
                );
            }
        }
        if let Some(Chosen { edges, pour }) = &self.edges {
            let _ = writeln!(
                text,
                "\n**Shipped**: two thresholds. Slip begins at a confidence of {} and ends below {} per mille: the best balanced accuracy in \
                 these pours with at most {FALSE_PER_HOUR_MAX} false alarms an hour and {FALSE_2800_MAX} false steps in 2800. \
                 Result: balanced {:.3}; {:.0} steps missed and {:.0} false in 2800; {:.0} % of {} slips caught within 50 ms; \
                 {:.0} false alarms an hour.",
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
        let silent = self.features.ready_after();
        let _ = writeln!(
            text,
            "\n## Limits\n\nIt knows the sensor, the materials and the ways of slipping of the data above, and no others. It reports nothing \
             in the first {silent} readings ({:.2} s). A report ends late, since its windows still hold the slip. Confidence is calibrated \
             for the data's share of slip. `tenax evaluate --network` scores it on data that nothing was chosen by.",
            silent as f64 / 80.0
        );
        text
    }
}
