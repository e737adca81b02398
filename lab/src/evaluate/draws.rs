//! Where the method fails: the score of pours against each quantity that sessions draw.

use serde::Serialize;
use serde_json::Value;

use crate::dataset::session::Session;
use tenax_sim::array::real::{Logits, auc};
use tenax_sim::array::steps::Steps;
use tenax_sim::array::{Verdicts, events};
use tenax_sim::labelled::Recording;
use tenax_sim::scorer::{Card, Doing};

/// Parts that each quantity's sessions are cut into, as many sessions in each.
const PARTS: usize = 4;
/// What a session's record holds beside its drawn quantities.
const NO_DRAW: [&str; 2] = ["seed", "specimen"];

/// The scores of those sessions whose quantity lies between two numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// The least that was drawn.
    pub from: f64,
    /// The greatest.
    pub to: f64,
    /// Probability that a step of their pours that slips has a higher logit than one that does not: what no threshold changes.
    pub auc: f64,
    /// Balanced accuracy of their pours' steps.
    pub balanced: f64,
    /// Part of their slips that was caught. Null if there was none.
    pub caught: Option<f64>,
    pub false_per_hour: f64,
}

/// The scores against one quantity.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Draw {
    /// What it is, as in the manifest, or what is made of two of them.
    pub quantity: String,
    /// From its lowest sessions to its highest.
    pub parts: Vec<Part>,
    /// Greatest less least area of the parts: how much it matters.
    pub matters: f64,
}

/// A session's drawn quantities, and what the array can tell from them: how much of what slides shows over its noise.
fn quantities(session: &Session) -> Vec<(String, f64)> {
    let mut all: Vec<(String, f64)> = match serde_json::to_value(session) {
        Ok(Value::Object(fields)) => fields
            .into_iter()
            .filter(|(name, _)| !NO_DRAW.contains(&name.as_str()))
            .filter_map(|(name, value)| Some((name, value.as_f64()?)))
            .collect(),
        _ => Vec::new(),
    };
    all.push(("mu_d / mu_s".to_owned(), session.mu_d / session.mu_s));
    // Of 1 N of load under an element, what slides throws (mV) over what a reading is noisy by.
    let drop = (session.mu_s - session.mu_d) * session.slip_part;
    all.push(("signal / noise".to_owned(), drop * session.mv_per_n / session.noise_mv));
    all
}

/// Scores pours against every quantity, the one that matters most first. Sessions are those that the recordings are of.
pub fn draws(
    sessions: &[Session],
    recordings: &[Recording],
    said: &[Verdicts],
    logits: &[Logits],
) -> Vec<Draw> {
    let judged: Vec<Judged> = recordings
        .iter()
        .zip(said.iter().zip(logits))
        .filter(|(recording, _)| recording.doing == Doing::Pour)
        .filter_map(|(recording, (said, logits))| {
            let session = sessions.iter().find(|session| session.name == recording.session)?;
            Some(Judged { session, recording, said, logits })
        })
        .collect();
    let Some(Judged { session: first, .. }) = judged.first() else { return Vec::new() };
    let mut all: Vec<Draw> = (0..quantities(first).len())
        .map(|n| {
            let mut sorted: Vec<_> = judged.iter().map(|own| (quantities(own.session)[n].1, own)).collect();
            sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
            let size = sorted.len().div_ceil(PARTS).max(1);
            let parts: Vec<Part> = sorted.chunks(size).map(part).collect();
            let areas = || parts.iter().map(|part| part.auc);
            let matters = areas().fold(0.0, f64::max) - areas().fold(1.0, f64::min);
            Draw { quantity: quantities(first)[n].0.clone(), parts, matters }
        })
        .collect();
    all.sort_by(|a, b| b.matters.total_cmp(&a.matters));
    all
}

/// A pour, and what a network made of it.
struct Judged<'a> {
    session: &'a Session,
    recording: &'a Recording,
    said: &'a Verdicts,
    logits: &'a Logits,
}

fn part(own: &[(f64, &Judged)]) -> Part {
    let (mut steps, mut card, mut scored) = (Steps::default(), Card::default(), Vec::new());
    for (_, Judged { recording, said, logits, .. }) in own {
        steps.take(&recording.steps, said);
        card.add(&events::card(recording, said));
        let judged = recording.steps.iter().zip(*logits);
        scored.extend(judged.filter_map(|(step, logit)| Some((f64::from((*logit)?), step.slip))));
    }
    Part {
        from: own.first().map_or(0.0, |own| own.0),
        to: own.last().map_or(0.0, |own| own.0),
        auc: auc(&mut scored),
        balanced: steps.balanced,
        caught: card.caught_part(),
        false_per_hour: card.false_alarms.per_hour,
    }
}
