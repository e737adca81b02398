//! From sequences to a network that was chosen on sessions it had not seen.

use anyhow::{bail, ensure};
use serde::Serialize;
use tenax_logic::array::FEATURES;
use tenax_sim::labelled::Part;
use tenax_sim::scorer::Doing;

use crate::equations;
use crate::train::features::Sequence;
use crate::train::network::{Learner, Network};
use crate::train::score::{Aim, Judged, platt, score, threshold};
use crate::train::table::{Standard, Table};

/// Most folds that sessions are left out in.
const FOLDS_MAX: usize = 5;

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Candidate {
    pub shyness: f32,
    /// Penalty of a squared weight of the logistic regression, a row.
    pub ridge: f64,
    /// Whether the network begins as the logistic regression.
    pub warm: bool,
    /// Passes over the data that the learning rate is spread over.
    pub epochs: usize,
    pub learning_rate: f64,
    pub decay: f64,
}

/// For a large data set with validation sessions: quickly from random weights, with all but variances and structure functions scaled to
/// a tenth, since the rest tells arrays apart sooner than sliding.
pub const SHIPPED: [Candidate; 1] =
    [Candidate { shyness: 0.1, ridge: 1e-4, warm: false, epochs: 12, learning_rate: 2e-3, decay: 1e-2 }];

/// For a few objects: each begins as a logistic regression, and how far it leaves that is chosen on objects that were left out.
pub const FEW_OBJECTS: [Candidate; 2] = [few(0.1), few(1.0)];

const fn few(shyness: f32) -> Candidate {
    Candidate { shyness, ridge: 4e-3, warm: true, epochs: 4, learning_rate: 3e-4, decay: 1e-1 }
}

/// Weights and bias, on the common scale.
pub type Linear = (Vec<f32>, f32);

/// Logistic regression; with `balanced`, rows of the rarer kind count so many times that both kinds count about alike.
fn logistic(table: &Table, standard: &Standard, ridge: f64, balanced: bool) -> Linear {
    let slips = table.slips.iter().filter(|&&slips| slips).count();
    let (rare, often) = (slips.min(table.count() - slips), slips.max(table.count() - slips));
    let times = if balanced { (often as f64 / rare.max(1) as f64).round().max(1.0) } else { 1.0 };
    let rare_slips = slips < table.count() - slips;
    let rows = standard.apply(table);
    let ridge = ridge * (often as f64 + times * rare as f64);
    let (weights, bias) = equations::logistic(FEATURES, table.count(), ridge, |n, factors| {
        let row = &rows[n * FEATURES..][..FEATURES];
        factors.iter_mut().zip(row).for_each(|(to, &x)| *to = x.into());
        (table.slips[n], if table.slips[n] == rare_slips { times } else { 1.0 })
    });
    (weights.into_iter().map(|weight| weight as f32).collect(), bias as f32)
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Choice {
    pub candidate: Candidate,
    /// Passes done of the candidate's; 0 is the logistic regression itself.
    pub passes: usize,
    /// Balanced accuracy on sessions it had not seen.
    pub unseen: f64,
    pub threshold: f64,
    /// Slope and intercept that turn its logit into log-odds.
    pub calibration: (f64, f64),
}

#[derive(Clone, Debug)]
pub struct Trained {
    pub network: Network,
    pub choice: Choice,
}

struct Fold<'a> {
    learn: Vec<&'a Sequence>,
    judge: Vec<&'a Sequence>,
}

/// Trains every candidate on some sessions, judges it on others, as the file's parts say or left out in turn, and trains the best one on
/// all of them. `progress` gets the part of the work that is done. Fails if there is too little to choose by, or the optimiser fails.
pub fn fit(
    sequences: &[Sequence],
    candidates: &[Candidate],
    aim: Aim,
    seed: u64,
    progress: &mut dyn FnMut(f64),
) -> anyhow::Result<Trained> {
    let folds = folds(sequences)?;
    let learn: Vec<&Sequence> = sequences.iter().filter(|own| may_learn(own)).collect();
    // With parts given, what is judged has learned all that there is to learn from: it need not learn it again.
    let whole = folds.len() == 1 && folds[0].learn.len() == learn.len();
    let mut best: Option<(Choice, Option<Network>)> = None;
    let pieces = (candidates.len() * folds.len() + 1) as f64;
    for (place, &candidate) in candidates.iter().enumerate() {
        // Of each number of passes, what every fold's network says of the sessions it has not seen.
        let mut judged = vec![Vec::<Judged>::new(); candidate.epochs + 1];
        let mut networks = vec![None; candidate.epochs + 1];
        for (n, fold) in folds.iter().enumerate() {
            let unseen = Table::of(judged_by(&fold.judge, aim));
            run(&fold.learn, candidate, candidate.epochs, (aim, seed), &mut |passes, network| {
                judged[passes].push(judge(network, &unseen));
                networks[passes] = whole.then(|| network.clone());
                let done = (place * folds.len() + n) as f64 + passes as f64 / candidate.epochs.max(1) as f64;
                progress(done / pieces);
            })?;
        }
        let mut own: Option<Choice> = None;
        for (passes, judged) in judged.iter().enumerate().filter(|(_, judged)| !judged.is_empty()) {
            let choice = choice(candidate, passes, judged, aim);
            if own.is_none_or(|own| choice.unseen > own.unseen) {
                own = Some(choice);
            }
        }
        let Some(own) = own else { continue };
        if best.as_ref().is_none_or(|(best, _)| own.unseen > best.unseen) {
            best = Some((own, networks.swap_remove(own.passes)));
        }
    }
    let Some((choice, mut network)) = best else { bail!("no candidate to choose from") };
    if network.is_none() {
        run(&learn, choice.candidate, choice.passes, (aim, seed), &mut |_, now| network = Some(now.clone()))?;
    }
    progress(1.0);
    let Some(network) = network else { bail!("nothing was learned") };
    Ok(Trained { network, choice })
}

fn judged_by<'a>(judge: &[&'a Sequence], aim: Aim) -> Vec<&'a Sequence> {
    let is_pour = |own: &&Sequence| own.doing == Doing::Pour;
    let only_pours = aim == Aim::Pours && judge.iter().any(is_pour);
    judge.iter().copied().filter(|own| !only_pours || is_pour(own)).collect()
}

/// Sequences that the final network learns: of the training part, or all that are for nothing in particular.
fn may_learn(sequence: &Sequence) -> bool {
    matches!(sequence.part, None | Some(Part::Train))
}

fn folds(sequences: &[Sequence]) -> anyhow::Result<Vec<Fold<'_>>> {
    let of = |part: Part| sequences.iter().filter(|own| own.part == Some(part)).collect();
    let (learn, judge): (Vec<_>, Vec<_>) = (of(Part::Train), of(Part::Validation));
    if !learn.is_empty() {
        ensure!(!judge.is_empty(), "the data set has a training part but no validation part to choose by");
        return Ok(vec![Fold { learn, judge }]);
    }
    let all: Vec<&Sequence> = sequences.iter().filter(|own| may_learn(own)).collect();
    let mut sessions: Vec<&str> = Vec::new();
    for sequence in &all {
        if !sessions.contains(&sequence.session.as_str()) {
            sessions.push(&sequence.session);
        }
    }
    ensure!(
        sessions.len() >= 2,
        "all recordings are of one session or object ({}): at least two are needed, to choose on one what was learned on \
         the other; name the column that tells them apart as [recordings] session in the recipe",
        sessions.first().unwrap_or(&"none")
    );
    let count = sessions.len().min(FOLDS_MAX);
    let is_in = |own: &Sequence, fold| {
        sessions.iter().position(|session| *session == own.session).is_some_and(|n| n % count == fold)
    };
    let fold = |fold| {
        let (judge, learn) = all.iter().partition(|own| is_in(own, fold));
        Fold { learn, judge }
    };
    Ok((0..count).map(fold).collect())
}

/// Trains on some sequences, and shows the network after each pass; pass 0 is the logistic regression.
fn run(
    learn: &[&Sequence],
    candidate: Candidate,
    passes: usize,
    (aim, seed): (Aim, u64),
    seen: &mut dyn FnMut(usize, &Network),
) -> anyhow::Result<()> {
    let table = Table::of(learn.iter().copied());
    let slips = table.slips.iter().filter(|&&slips| slips).count();
    ensure!(
        slips > 0 && slips < table.count(),
        "of {} steps to learn from {slips} slip: both kinds are needed",
        table.count()
    );
    let standard = Standard::of(&table, candidate.shyness);
    let balanced = aim == Aim::Balanced;
    let begin = candidate.warm.then(|| logistic(&table, &standard, candidate.ridge, balanced));
    let mut learner = Learner::new(&standard, candidate, seed, begin.as_ref())?;
    if begin.is_some() {
        seen(0, &learner.network()?);
    }
    if passes > 0 {
        learner.learn(&table, balanced, &mut |epoch, network| {
            seen(epoch + 1, network);
            epoch + 1 < passes
        })?;
    }
    Ok(())
}

pub fn judge(network: &Network, table: &Table) -> Judged {
    Judged { logits: network.logits(table), slips: table.slips.clone() }
}

/// One threshold for all folds together; the score is the mean of the folds', so that a large one is not all that counts.
fn choice(candidate: Candidate, passes: usize, judged: &[Judged], aim: Aim) -> Choice {
    let mut all = Judged::default();
    for fold in judged {
        all.extend(fold);
    }
    let threshold = threshold(&all, aim);
    let unseen =
        judged.iter().map(|fold| score(fold, threshold).balanced).sum::<f64>() / judged.len().max(1) as f64;
    Choice { candidate, passes, unseen, threshold, calibration: platt(&all) }
}
