//! `tenax chart table`: slips caught and false alarms of each detector, on the same fingertips, scenes and hours.

pub mod heard;
pub mod rivals;
pub mod scored;

use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;
use serde::Serialize;
use tenax_logic::array::{FEATURES, Features};
use tenax_sim::jobs::Jobs;

use super::Progress;
use heard::{Heard, Judge, Kind, Plan};
use rivals::{Row, learn};
use scored::{Between, Scored};

/// One in so many steps without slip is learned from.
const THINNED: u32 = 4;
/// False alarms an hour of a rival's threshold, in quiet minutes and in disturbed ones of the fingertips that it is chosen on.
const CAPS: [f64; 2] = [10.0, 60.0];

/// Fingertips that the logistic regressions learn from; those that thresholds are chosen on; those that are scored.
pub const PLANS: [Plan; 3] = [plan(25_001, 3, 1), plan(25_002, 3, 3), plan(25_003, 8, 3)];

const fn plan(seed: u64, fingers: usize, minutes: u64) -> Plan {
    Plan { seed, fingers, pours: 3, picks: 3, minutes }
}

/// A line of the table. A figure that does not apply is null.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    pub name: String,
    /// Part of the slips of at least 1 mm that were caught.
    pub recall_1mm: Option<Between>,
    /// The report less macro onset, ms, of those that were caught; negative is early.
    pub latency_ms_p50: Option<f64>,
    pub latency_ms_p95: Option<f64>,
    /// False alarms an hour in quiet minutes, in disturbed ones, and between slips as balls are poured and boxes are lifted.
    pub quiet: Option<Between>,
    pub disturbed: Option<Between>,
    pub between_slips: Option<Between>,
    /// The threshold that was chosen on other fingertips.
    pub threshold: Option<i32>,
}

impl Line {
    fn new(row: &Row, scored: &Scored) -> Self {
        Self {
            name: row.name.clone(),
            recall_1mm: scored.recall(),
            latency_ms_p50: scored.latency_ms(0.50),
            latency_ms_p95: scored.latency_ms(0.95),
            quiet: scored.false_per_hour(Kind::Quiet),
            disturbed: scored.false_per_hour(Kind::Disturbed),
            between_slips: scored.false_per_hour(Kind::Slips),
            threshold: row.threshold,
        }
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// The data that every row was scored on.
    pub data: String,
    pub slips_1mm: usize,
    pub rows: Vec<Line>,
}

/// Hears every fingertip of a plan with these judges. Fails if a scene cannot be made.
fn hear(
    plan: &Plan,
    taught: bool,
    judges: &(dyn Fn() -> Vec<Judge> + Sync),
    jobs: &Jobs,
) -> anyhow::Result<Vec<Heard>> {
    let all = (0..plan.count()).into_par_iter().map(|n| {
        let fingertip = plan.fingertip(n, taught)?;
        let mut job = jobs.begin();
        fingertip.record(plan, judges, &mut |part| job.at(part))
    });
    Ok(all.collect::<anyhow::Result<Vec<_>>>()?.into_iter().flatten().collect())
}

type Steps = Arc<Mutex<Vec<(Features, bool)>>>;

/// Keeps every step of the array in which the object slides, and some of the others.
fn keeps(steps: Steps) -> Judge {
    Box::new(move |felt| {
        if let Some(features) = felt.features {
            // By content, not by order: fingertips are heard side by side.
            let mark =
                features.iter().fold(0_u32, |mark, &own| mark.wrapping_mul(31).wrapping_add(own as u32));
            if felt.slides || mark.is_multiple_of(THINNED) {
                steps.lock().unwrap_or_else(PoisonError::into_inner).push((*features, felt.slides));
            }
        }
        false
    })
}

/// Learns, chooses, hears and scores. Fails if a scene cannot be made.
pub fn table(plans: &[Plan; 3], progress: Progress) -> anyhow::Result<Table> {
    let [learned, chosen, scored] = plans;
    let jobs = Jobs::new(plans.iter().map(Plan::count).sum(), progress);
    let steps = Steps::default();
    hear(learned, false, &|| vec![keeps(Arc::clone(&steps))], &jobs)?;
    let mut steps = std::mem::take(&mut *steps.lock().unwrap_or_else(PoisonError::into_inner));
    // Sums of floats depend on the order.
    steps.sort_unstable();
    let rivals = rivals::rivals(learn(&steps, FEATURES), learn(&steps, rivals::OF_PAPER));
    let tried =
        || rivals.iter().flat_map(|own| own.grid.iter().flat_map(|&at| own.judges(Some(at)))).collect();
    let heard = hear(chosen, false, &tried, &jobs)?;
    let (mut from, mut rows) = (0, rivals::rows());
    for rival in rivals {
        rows.extend(CAPS.map(|cap| Row {
            name: format!("{}, {cap} false/h", rival.name),
            threshold: choose(&rival.grid, &heard, from, cap),
            ..rival.clone()
        }));
        from += rival.grid.len();
    }
    let fresh = || rows.iter().flat_map(|row| row.judges(row.threshold)).collect();
    let heard = hear(scored, true, &fresh, &jobs)?;
    Ok(Table::of(&rows, &heard, scored))
}

/// The threshold that catches the most slips of a millimetre within the cap; if there is none, the one with the fewest false alarms.
fn choose(grid: &[i32], heard: &[Heard], from: usize, cap: f64) -> Option<i32> {
    let rank = |(n, at): (usize, &i32)| {
        let scored = Scored::of(heard, from + n..from + n + 1);
        let value = |own: Option<Between>| own.map_or(0.0, |[value, ..]| value);
        let worst = [Kind::Quiet, Kind::Disturbed].map(|kind| value(scored.false_per_hour(kind)));
        let worst = worst[0].max(worst[1]);
        (if worst <= cap { (1, value(scored.recall())) } else { (0, -worst) }, *at)
    };
    let ranks = grid.iter().enumerate().map(rank);
    // The first of equals.
    ranks.reduce(|best, next| if next.0 > best.0 { next } else { best }).map(|(_, at)| at)
}

impl Table {
    fn of(rows: &[Row], heard: &[Heard], plan: &Plan) -> Self {
        let whole = Scored::of(heard, 0..0);
        let data = format!(
            "{} fingertips of seed {}: {} pours and picks, {:.1} h quiet, {:.1} h disturbed",
            plan.count(),
            plan.seed,
            heard.iter().filter(|own| own.kind == Kind::Slips).count(),
            whole.hours(Kind::Quiet),
            whole.hours(Kind::Disturbed)
        );
        let mut from = 0;
        let line = |row: &Row| {
            let judges = row.judges(None).len();
            from += judges;
            Line::new(row, &Scored::of(heard, from - judges..from))
        };
        Self { data, slips_1mm: whole.count(), rows: rows.iter().map(line).collect() }
    }
}
