//! `tenax chart table`: slips caught, false alarms and cost of each detector, on the same fingertips, scenes and hours.

pub mod costs;
pub mod heard;
pub mod rivals;
pub mod scored;

use std::sync::{Mutex, PoisonError};

use plotters::style::RGBColor;
use rayon::prelude::*;
use serde::Serialize;
use tenax_logic::array::{FEATURES, Features};
use tenax_sim::jobs::Jobs;
use tenax_sim::plot::figure::colour;
use tenax_sim::plot::sheet::{Axis, Mark, Panel, Series, Sheet};

use super::{Chart, Progress, csv};
use costs::Costs;
use heard::{Heard, Judge, Kind, Plan};
use rivals::{CAPS, Cap, Rival, Row, learn};
use scored::{Between, SLID_MM, Scored};

/// One in so many steps without slip is learned from.
const THINNED: u32 = 4;

/// Fingertips that the logistic regressions learn from; those that thresholds are chosen on; those that are scored.
pub const PLANS: [Plan; 3] = [plan(25_001, 3, 1), plan(25_002, 3, 3), plan(25_003, 8, 3)];

const fn plan(seed: u64, fingers: usize, minutes: u64) -> Plan {
    Plan { seed, fingers, pours: 3, picks: 3, minutes }
}

/// A line of the table. A figure that does not apply is null. Low and high are ends of 95 % intervals.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    pub name: String,
    /// Part of the slips of at least 1 mm that were caught; of 0.1 mm, of 5 mm.
    pub recall_1mm: Option<f64>,
    pub recall_1mm_low: Option<f64>,
    pub recall_1mm_high: Option<f64>,
    pub recall_0_1mm: Option<f64>,
    pub recall_5mm: Option<f64>,
    /// Part of the slips of at least 1 mm in which nothing began, but a report stood since before.
    pub stood_before_1mm: Option<f64>,
    /// The report less macro onset, ms, of slips of at least 1 mm that were caught; negative is early.
    pub latency_ms_p50: Option<f64>,
    pub latency_ms_p95: Option<f64>,
    /// Macro onset less the report, ms, of those that came before it.
    pub lead_ms_p50: Option<f64>,
    /// False alarms an hour in quiet minutes, in disturbed ones, and while balls are poured and boxes are lifted.
    pub quiet: Option<f64>,
    pub quiet_low: Option<f64>,
    pub quiet_high: Option<f64>,
    pub disturbed: Option<f64>,
    pub disturbed_low: Option<f64>,
    pub disturbed_high: Option<f64>,
    pub slipping: Option<f64>,
    /// Processor time of a frame of 0.5 ms on this PC, ns, mean; and as a multiple of S1's.
    pub ns: Option<f64>,
    pub times_s1: Option<f64>,
    /// The threshold that was chosen on other fingertips.
    pub threshold: Option<i32>,
}

impl Line {
    fn new(row: &Row, scored: &Scored, costs: &Costs) -> Self {
        let ends = |own: Option<Between>| {
            [own.map(|own| own.value), own.map(|own| own.low), own.map(|own| own.high)]
        };
        let [recall_1mm, recall_1mm_low, recall_1mm_high] = ends(scored.recall(SLID_MM[1]));
        let [quiet, quiet_low, quiet_high] = ends(scored.false_per_hour(Kind::Quiet));
        let [disturbed, disturbed_low, disturbed_high] = ends(scored.false_per_hour(Kind::Disturbed));
        let ns = costs.of(row.parts);
        Self {
            name: row.name.clone(),
            recall_1mm,
            recall_1mm_low,
            recall_1mm_high,
            recall_0_1mm: ends(scored.recall(SLID_MM[0]))[0],
            recall_5mm: ends(scored.recall(SLID_MM[2]))[0],
            stood_before_1mm: scored.stood_before(SLID_MM[1]),
            latency_ms_p50: scored.latency_ms(0.50),
            latency_ms_p95: scored.latency_ms(0.95),
            lead_ms_p50: scored.lead_ms(),
            quiet,
            quiet_low,
            quiet_high,
            disturbed,
            disturbed_low,
            disturbed_high,
            slipping: ends(scored.false_per_hour(Kind::Slips))[0],
            ns,
            times_s1: ns.zip(costs.of(&["s1"])).map(|(own, s1)| own / s1),
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

/// Hears every fingertip of a plan with these rows. `steps` gets every step of the array. Fails if a scene cannot be made.
fn hear(
    plan: &Plan,
    taught: bool,
    rows: &(dyn Fn() -> Vec<Box<dyn Judge>> + Sync),
    steps: &(dyn Fn(&Features, bool) + Sync),
    jobs: &Jobs,
) -> anyhow::Result<Vec<Heard>> {
    let all = (0..plan.count()).into_par_iter().map(|n| {
        let fingertip = plan.fingertip(n, taught)?;
        let mut job = jobs.begin();
        let mut done = 0.0;
        fingertip.record(plan, rows, &mut |features, slips| steps(features, slips), &mut || {
            done += 1.0 / plan.recordings() as f64;
            job.at(done);
        })
    });
    Ok(all.collect::<anyhow::Result<Vec<_>>>()?.into_iter().flatten().collect())
}

/// Learns, chooses, hears and scores. Fails if a scene cannot be made.
pub fn table(plans: &[Plan; 3], costs: &Costs, progress: Progress) -> anyhow::Result<Table> {
    let [learned, chosen, scored] = plans;
    let jobs = Jobs::new(plans.iter().map(Plan::count).sum(), progress);
    let steps: Mutex<Vec<(Features, bool)>> = Mutex::default();
    let keep = |features: &Features, slips: bool| {
        // By content, not by order: fingertips are heard side by side.
        let mark = features.iter().fold(0_u32, |mark, &own| mark.wrapping_mul(31).wrapping_add(own as u32));
        if slips || mark.is_multiple_of(THINNED) {
            steps.lock().unwrap_or_else(PoisonError::into_inner).push((*features, slips));
        }
    };
    hear(learned, false, &Vec::new, &keep, &jobs)?;
    let mut steps = steps.into_inner().unwrap_or_else(PoisonError::into_inner);
    // Sums of floats depend on the order.
    steps.sort_unstable();
    let rivals = rivals::rivals(&learn(&steps, FEATURES), &learn(&steps, rivals::OF_PAPER));
    drop(steps);
    let tried = || rivals.iter().flat_map(|own| own.grid.iter().map(|&at| own.judge(at))).collect();
    let heard = hear(chosen, false, &tried, &|_, _| (), &jobs)?;
    let mut from = 0;
    let mut rows = rivals::rows();
    for rival in &rivals {
        rows.extend(CAPS.iter().map(|cap| rival.row(choose(rival, &heard, from, cap), cap)));
        from += rival.grid.len();
    }
    let fresh = || rows.iter().flat_map(|row| (row.make)()).collect();
    let heard = hear(scored, true, &fresh, &|_, _| (), &jobs)?;
    Ok(Table::of(&rows, &heard, scored, costs))
}

/// The threshold that catches the most slips of a millimetre within the cap; if there is none, the one with the fewest false alarms.
fn choose(rival: &Rival, heard: &[Heard], from: usize, cap: &Cap) -> i32 {
    let mut best = None;
    for (n, &at) in rival.grid.iter().enumerate() {
        let scored = Scored::of(heard, from + n..from + n + 1);
        let per_hour = |kind| scored.false_per_hour(kind).map_or(0.0, |own| own.value);
        let worst = per_hour(Kind::Quiet).max(per_hour(Kind::Disturbed)) / cap.held;
        let worst = worst.max(per_hour(Kind::Slips) / cap.slips);
        let caught = scored.recall(SLID_MM[1]).map_or(0.0, |own| own.value);
        let rank = if worst <= 1.0 { (1, caught) } else { (0, -worst) };
        if best.is_none_or(|(other, _)| rank > other) {
            best = Some((rank, at));
        }
    }
    best.map_or(i32::MAX, |(_, at)| at)
}

/// Look of a row in the chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Group {
    Ships,
    Pair,
    Control,
    Rival,
}

impl Group {
    fn of(row: &Line) -> Self {
        match row.name.as_str() {
            _ if row.threshold.is_some() => Self::Rival,
            name if name.contains(',') => Self::Control,
            name if name.contains(' ') => Self::Pair,
            _ => Self::Ships,
        }
    }

    const fn look(self) -> (&'static str, RGBColor, Mark) {
        match self {
            Self::Ships => ("ships", colour::VERMILLION, Mark::Dots),
            Self::Pair => ("a pair, the hand", colour::BLUE, Mark::Dots),
            Self::Control => ("the network, changed", colour::GREEN, Mark::Crosses),
            Self::Rival => ("a rival, its threshold chosen on other fingertips", colour::PURPLE, Mark::Rings),
        }
    }
}

/// Height of a line of words as a part of the panel's, and width of a name in decades.
const WORD: f64 = 0.062;
const NAME: f64 = 0.7;

impl Table {
    fn of(rows: &[Row], heard: &[Heard], plan: &Plan, costs: &Costs) -> Self {
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
            let judges = (row.make)().len();
            from += judges;
            Line::new(row, &Scored::of(heard, from - judges..from), costs)
        };
        Self { data, slips_1mm: whole.count(SLID_MM[1]), rows: rows.iter().map(line).collect() }
    }

    /// Recall against processor time, the false alarms named. Fails if it cannot be drawn.
    pub fn chart(&self) -> anyhow::Result<Chart> {
        let header = "name,ns,times_s1,recall_1mm,low,high,quiet_per_hour,disturbed_per_hour";
        let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.3}"));
        let rows = self.rows.iter().map(|row| {
            let recall = [row.recall_1mm, row.recall_1mm_low, row.recall_1mm_high];
            let numbers = [row.ns, row.times_s1].into_iter().chain(recall).chain([row.quiet, row.disturbed]);
            std::iter::once(row.name.clone()).chain(numbers.map(number)).collect()
        });
        let csv = csv(header, rows)?;
        let panels = vec![
            self.panel("what ships, in pairs, and the hand", |group| {
                matches!(group, Group::Ships | Group::Pair)
            }),
            self.panel("rivals", |group| group == Group::Rival),
            self.panel("the network with something of its learning changed", |group| group == Group::Control),
        ];
        let sheet = Sheet::new(
            "Slips caught against processor time",
            "A report must begin between micro onset and 50 ms after macro onset. In brackets: false alarms in a quiet hour, in a disturbed one.",
            1,
            panels,
        );
        Chart::new("table", &sheet, csv)
    }

    /// The rows of some groups, each with its name beside it.
    fn panel(&self, title: &str, shows: impl Fn(Group) -> bool) -> Panel {
        let (mut series, mut words) = (Vec::new(), Vec::new());
        for row in self.rows.iter().filter(|row| shows(Group::of(row))) {
            let Some((at, recall)) = row.times_s1.zip(row.recall_1mm) else { continue };
            let (name, colour, mark) = Group::of(row).look();
            series.push(Series::new(name, colour, mark, [(at, recall)]));
            let ends = [row.recall_1mm_low, row.recall_1mm_high].map(|end| (at, end.unwrap_or(recall)));
            series.push(Series::new("95 %", colour::GREY, Mark::Line, ends));
            let whole =
                |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.0}"));
            let [quiet, disturbed] = [row.quiet, row.disturbed].map(whole);
            words.push((1.06 * at, recall, format!("{} ({quiet}, {disturbed})", row.name)));
        }
        words.sort_by(|a, b| b.1.total_cmp(&a.1));
        let apart = |a: &(f64, f64, String), b: &(f64, f64, String)| (a.0 / b.0).log10().abs() > NAME;
        // From the top down each under those before it, then from the bottom up each above those below.
        for n in 0..words.len() {
            let above = words[..n].iter().filter(|own| !apart(own, &words[n]));
            words[n].1 = above.map(|own| own.1 - WORD).fold(words[n].1, f64::min);
        }
        for n in (0..words.len()).rev() {
            let below = words[n + 1..].iter().filter(|own| !apart(own, &words[n]));
            words[n].1 = below.map(|own| own.1 + WORD).fold(words[n].1.max(WORD / 2.0), f64::max);
        }
        let x = Axis::log("processor time on this PC, times S1's", 0.1, 100.0);
        Panel { words, ..Panel::new(title, x, Axis::even("slips of at least 1 mm caught", 0.0, 1.0), series) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_is_drawn_on_another() {
        let rows = rivals::rows();
        let parts = rows.iter().flat_map(|row| row.parts.iter().copied());
        let costs = Costs(parts.map(|part| (part, 10.0)).collect());
        let mut table = Table::of(&rows, &[], &PLANS[2], &costs);
        for (n, row) in table.rows.iter_mut().enumerate() {
            row.recall_1mm = Some(0.02 * (n % 3) as f64);
        }
        let panel = table.panel("all", |_| true);
        assert_eq!(panel.words.len(), rows.len());
        for (n, own) in panel.words.iter().enumerate() {
            assert!(own.1 > 0.0, "{own:?}");
            for other in &panel.words[n + 1..] {
                let far = (own.0 / other.0).log10().abs() > NAME || (own.1 - other.1).abs() > 0.99 * WORD;
                assert!(far, "{own:?} {other:?}");
            }
        }
    }
}
