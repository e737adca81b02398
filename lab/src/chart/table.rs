//! `tenax chart table`: what each detector catches, and what it costs, side by side: the same fingertips, scenes and hours for all.

pub mod costs;
pub mod decisions;
pub mod heard;
pub mod rivals;
pub mod scored;

use std::fmt;
use std::sync::{Mutex, PoisonError};

use plotters::style::RGBColor;
use rayon::prelude::*;
use serde::Serialize;
use tenax_sim::jobs::Jobs;
use tenax_logic::array::{FEATURES, Features};
use tenax_sim::plot::figure::colour;
use tenax_sim::plot::sheet::{Axis, Mark, Panel, Series, Sheet};

use super::{Chart, Progress, csv};
use costs::Costs;
use heard::{Heard, Judge, Kind, Plan};
use rivals::{CAPS, Cap, Rival, Row, learn};
use scored::{Between, SLID_MM, Scored};

/// One in so many steps without slip is learned from.
const THINNED: u32 = 4;

/// How much is heard.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Fingertips that the logistic regressions learn from; those that thresholds are chosen on; those that are scored.
    pub plans: [Plan; 3],
}

impl Default for Options {
    fn default() -> Self {
        let plan = |seed, fingers, minutes| Plan { seed, fingers, pours: 3, picks: 3, minutes };
        Self { plans: [plan(25_001, 3, 1), plan(25_002, 3, 3), plan(25_003, 8, 3)] }
    }
}

/// A line of the table. A figure that does not apply is null.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    pub name: String,
    /// What it was scored on.
    pub data: String,
    /// Of a decision, its sensors' conditioning included.
    pub instructions_mean: Option<f64>,
    pub instructions_max: Option<u64>,
    /// Estimated (`docs/table.md`).
    pub cycles_mean: Option<f64>,
    pub cycles_least: Option<f64>,
    pub cycles_most: Option<f64>,
    pub flash_bytes: Option<u64>,
    pub ram_bytes: Option<u64>,
    /// The word less macro onset, ms, of slips of at least 1 mm that were caught; negative is early.
    pub latency_ms_p50: Option<f64>,
    pub latency_ms_p95: Option<f64>,
    /// Macro onset less the word, ms, of those that came before it.
    pub lead_ms_p50: Option<f64>,
    pub recall_1mm: Option<f64>,
    pub recall_1mm_low: Option<f64>,
    pub recall_1mm_high: Option<f64>,
    pub false_per_hour_quiet: Option<f64>,
    pub false_per_hour_disturbed: Option<f64>,
    /// Decisions a second that the instructions are of.
    pub decisions_per_s: Option<u32>,
    pub recall_0_1mm: Option<Between>,
    pub recall_5mm: Option<Between>,
    pub slips_1mm: usize,
    /// The part of these slips in which nothing began, but a word stood since before: said too early to be of this slip.
    pub stood_before_1mm: Option<f64>,
    pub quiet: Option<Between>,
    pub disturbed: Option<Between>,
    /// False alarms an hour while balls are poured and boxes are lifted.
    pub false_per_hour_slips: Option<f64>,
    /// The threshold that was chosen on other fingertips.
    pub threshold: Option<i32>,
}

impl Line {
    fn new(name: &str, data: &str, scored: &Scored, costs: Option<&costs::Cost>) -> Self {
        let recall = scored.recall(SLID_MM[1]);
        let [quiet, disturbed, slips] =
            [Kind::Quiet, Kind::Disturbed, Kind::Slips].map(|kind| scored.false_per_hour(kind));
        let value = |between: Option<Between>| between.map(|own| own.value);
        Self {
            name: name.to_owned(),
            data: data.to_owned(),
            instructions_mean: costs.map(|own| own.instructions_mean),
            instructions_max: costs.map(|own| own.instructions_max),
            cycles_mean: costs.and_then(|own| own.cycles).map(|[_, likely, _]| likely),
            cycles_least: costs.and_then(|own| own.cycles).map(|[least, ..]| least),
            cycles_most: costs.and_then(|own| own.cycles).map(|[.., most]| most),
            flash_bytes: costs.and_then(|own| own.flash_bytes),
            ram_bytes: costs.and_then(|own| own.ram_bytes),
            latency_ms_p50: scored.latency_ms(0.50),
            latency_ms_p95: scored.latency_ms(0.95),
            lead_ms_p50: scored.lead_ms(),
            recall_1mm: value(recall),
            recall_1mm_low: recall.map(|own| own.low),
            recall_1mm_high: recall.map(|own| own.high),
            false_per_hour_quiet: value(quiet),
            false_per_hour_disturbed: value(disturbed),
            decisions_per_s: costs.map(|own| own.per_s),
            recall_0_1mm: scored.recall(SLID_MM[0]),
            recall_5mm: scored.recall(SLID_MM[2]),
            slips_1mm: scored.count(SLID_MM[1]),
            stood_before_1mm: scored.stood_before(SLID_MM[1]),
            quiet,
            disturbed,
            false_per_hour_slips: value(slips),
            threshold: None,
        }
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct Table {
    pub rows: Vec<Line>,
}

/// Hears every fingertip of a plan with these rows. `steps` is told of every step of the array. Fails if a scene cannot be made.
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
pub fn table(options: &Options, costs: &Costs, progress: Progress) -> anyhow::Result<Table> {
    let [learned, chosen, scored] = &options.plans;
    let jobs = Jobs::new(options.plans.iter().map(Plan::count).sum(), progress);
    let steps: Mutex<Vec<(Features, bool)>> = Mutex::default();
    let keep = |features: &Features, slips: bool| {
        // By what it holds, not by when it comes: fingertips are heard side by side.
        let mark = features.iter().fold(0_u32, |mark, &own| mark.wrapping_mul(31).wrapping_add(own as u32));
        if slips || mark.is_multiple_of(THINNED) {
            steps.lock().unwrap_or_else(PoisonError::into_inner).push((*features, slips));
        }
    };
    hear(learned, false, &Vec::new, &keep, &jobs)?;
    let mut steps = steps.into_inner().unwrap_or_else(PoisonError::into_inner);
    // Sums of floats depend on the order.
    steps.sort_unstable();
    let (linear, paper) = (learn(&steps, FEATURES), learn(&steps, rivals::OF_PAPER));
    drop(steps);
    let rivals = rivals::rivals(&linear, &paper);
    let tried = || rivals.iter().flat_map(|own| own.grid.iter().map(|&at| own.judge(at))).collect();
    let heard = hear(chosen, false, &tried, &|_, _| (), &jobs)?;
    let mut from = 0;
    let mut rows = rivals::rows();
    for rival in &rivals {
        for cap in &CAPS {
            rows.push(rival.row(choose(rival, &heard, from, cap), cap));
        }
        from += rival.grid.len();
    }
    let heard = hear(scored, true, &|| fresh(&rows), &|_, _| (), &jobs)?;
    Ok(Table::of(&rows, &heard, scored, costs))
}

/// Judges for a recording, those of one row after those of another.
fn fresh(rows: &[Row]) -> Vec<Box<dyn Judge>> {
    rows.iter().flat_map(|row| (row.make)()).collect()
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

impl Table {
    fn of(rows: &[Row], heard: &[Heard], plan: &Plan, costs: &Costs) -> Self {
        let mut from = 0;
        let lines = rows.iter().map(|row| {
            let judges = (row.make)().len();
            let scored = Scored::of(heard, from..from + judges);
            from += judges;
            let data = format!(
                "{} fingertips of seed {}: {} pours and picks, {:.1} h quiet, {:.1} h disturbed",
                plan.count(),
                plan.seed,
                heard.iter().filter(|own| own.kind == Kind::Slips).count(),
                scored.hours(Kind::Quiet),
                scored.hours(Kind::Disturbed)
            );
            Line {
                threshold: row.threshold,
                ..Line::new(&row.name, &data, &scored, costs.of(row.kernels, row.per_s).as_ref())
            }
        });
        Self { rows: lines.collect() }
    }

    /// Recall against cycles, the false alarms named. Fails if it cannot be drawn.
    pub fn chart(&self) -> anyhow::Result<Chart> {
        let header = "name,instructions_mean,instructions_max,cycles_mean,decisions_per_s,flash_bytes,ram_bytes,\
            recall_1mm,low,high,quiet_per_hour,disturbed_per_hour";
        let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.3}"));
        let whole = |value: Option<u64>| value.map_or(String::new(), |value| value.to_string());
        let csv = csv(
            header,
            self.rows.iter().map(|row| {
                vec![
                    row.name.clone(),
                    number(row.instructions_mean),
                    whole(row.instructions_max),
                    number(row.cycles_mean),
                    whole(row.decisions_per_s.map(u64::from)),
                    whole(row.flash_bytes),
                    whole(row.ram_bytes),
                    number(row.recall_1mm),
                    number(row.recall_1mm_low),
                    number(row.recall_1mm_high),
                    number(row.false_per_hour_quiet),
                    number(row.false_per_hour_disturbed),
                ]
            }),
        )?;
        let panels = vec![
            self.panel("what ships, in pairs, and the hand", |group| {
                matches!(group, Group::Ships | Group::Pair)
            }),
            self.panel("rivals", |group| group == Group::Rival),
            self.panel("the network with something of its learning changed", |group| group == Group::Control),
        ];
        let sheet = Sheet::new(
            "Slips caught against cycles spent",
            "A word must begin between micro onset and 50 ms after macro onset. In brackets: false alarms in a quiet hour, in a disturbed one.",
            1,
            panels,
        );
        Chart::new("table", &sheet, csv)
    }
}

/// How a row is drawn.
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

/// What a line of words takes of the panel's height, and a name of its width, in decades.
const WORD: f64 = 0.062;
const NAME: f64 = 0.7;

impl Table {
    /// The rows of some groups, each with its name beside it.
    fn panel(&self, title: &str, shows: impl Fn(Group) -> bool) -> Panel {
        let (mut series, mut words) = (Vec::new(), Vec::new());
        for row in self.rows.iter().filter(|row| shows(Group::of(row))) {
            let (Some(cycles), Some(per_s), Some(recall)) =
                (row.cycles_mean, row.decisions_per_s, row.recall_1mm)
            else {
                continue;
            };
            let at = cycles * f64::from(per_s) / 1e6;
            let (name, colour, mark) = Group::of(row).look();
            series.push(Series::new(name, colour, mark, [(at, recall)]));
            let ends = [row.recall_1mm_low, row.recall_1mm_high].map(|end| (at, end.unwrap_or(recall)));
            series.push(Series::new("95 %", colour::GREY, Mark::Line, ends));
            let whole =
                |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.0}"));
            let [quiet, disturbed] = [row.false_per_hour_quiet, row.false_per_hour_disturbed].map(whole);
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
        let x = Axis::log("million cycles a second, estimated; the core has 100", 0.1, 100.0);
        Panel { words, ..Panel::new(title, x, Axis::even("slips of at least 1 mm caught", 0.0, 1.0), series) }
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(row) = self.rows.first() {
            writeln!(f, "{}; {} slips of at least 1 mm", row.data, row.slips_1mm)?;
        }
        write!(f, "{:<26}{:>18}", "", "caught, of 1 mm")?;
        let head =
            "0.1|5 mm|ms p50|p95|lead|quiet/h|disturbed/h|slipping/h|instr.|worst|cycles|at Hz|flash|RAM";
        head.split('|').try_for_each(|word| write!(f, "{word:>12}"))?;
        writeln!(f)?;
        for row in &self.rows {
            let number = |value: Option<f64>, places: usize| {
                value.map_or_else(|| "-".to_owned(), |value| format!("{value:.places$}"))
            };
            let whole = |value: Option<u64>| value.map_or_else(|| "-".to_owned(), |value| value.to_string());
            let part = |own: Option<Between>| number(own.map(|own| own.value), 2);
            let rate = |own: Option<Between>| {
                own.map_or_else(
                    || "-".to_owned(),
                    |own| format!("{:.0} ({:.0}-{:.0})", own.value, own.low, own.high),
                )
            };
            let recall = format!(
                "{} ({}-{})",
                number(row.recall_1mm, 2),
                number(row.recall_1mm_low, 2),
                number(row.recall_1mm_high, 2)
            );
            write!(f, "{:<26}{recall:>18}", row.name)?;
            for word in [
                part(row.recall_0_1mm),
                part(row.recall_5mm),
                number(row.latency_ms_p50, 0),
                number(row.latency_ms_p95, 0),
                number(row.lead_ms_p50, 0),
                rate(row.quiet),
                rate(row.disturbed),
                number(row.false_per_hour_slips, 0),
                number(row.instructions_mean, 0),
                whole(row.instructions_max),
                number(row.cycles_mean, 0),
                whole(row.decisions_per_s.map(u64::from)),
                whole(row.flash_bytes),
                whole(row.ram_bytes),
            ] {
                write!(f, "{word:>12}")?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn no_name_is_drawn_on_another() {
        let rows = rivals::rows();
        let kernels = rows.iter().flat_map(|row| row.kernels.iter().copied());
        let kernel =
            costs::Kernel { per_s: 80.0, mean: 10.0, max: 10, cycles: Some([10.0; 3]), ..Default::default() };
        let costs = Costs(kernels.map(|name| (name.to_owned(), kernel.clone())).collect::<BTreeMap<_, _>>());
        let plan = Options::default().plans[2];
        let mut table = Table::of(&rows, &[], &plan, &costs);
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
