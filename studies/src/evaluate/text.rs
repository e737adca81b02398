//! The scores for people.

use std::fmt::{self, Display};

use tenax_bench::array::steps::{By, Steps};

use super::report::Report;

/// Prints as text.
#[derive(Clone, Copy, Debug)]
pub struct Text<'a>(pub &'a Report);

impl Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let report = self.0;
        let Report { events, without_lookback: without, .. } = report;
        if let Some(pour) = &report.pour {
            writeln!(
                f,
                "pours alone: balanced {:.3}, {:.2} % right of {} steps; {:.1} % slip, so 'never' has {:.2} %",
                pour.balanced,
                100.0 * pour.accuracy,
                pour.steps,
                100.0 * pour.prevalence,
                100.0 * (1.0 - pour.prevalence)
            )?;
            writeln!(
                f,
                "  {:<20}{:.0} missed, {:.0} false",
                "in 2800 steps", pour.missed_2800, pour.false_2800
            )?;
            if let Some(caught) = pour.caught_50ms {
                writeln!(
                    f,
                    "  {:<20}{:.1} % of {} caught within 50 ms of macro onset, {:.1} false alarms an hour",
                    "slips",
                    100.0 * caught,
                    pour.slips,
                    pour.false_per_hour
                )?;
            }
            rows(f, "  by material, the worst first", &pour.by_material)?;
        }
        if let Some(roc) = &report.roc {
            writeln!(
                f,
                "pours at other thresholds: AUC {:.3}, average precision {:.3}, best balanced {:.3}",
                roc.auc, roc.average_precision, roc.best_balanced.balanced
            )?;
            for point in &roc.points {
                writeln!(
                    f,
                    "  balanced {:.3}: {:>4.0} missed, {:>5.1} false in 2800; {:>5.1} % caught, {:>6.0} false alarms an hour; precision {:.2}",
                    point.balanced,
                    point.missed_2800,
                    point.false_2800,
                    100.0 * point.caught_50ms,
                    point.false_per_hour,
                    point.precision
                )?;
            }
        }
        if !report.by_draw.is_empty() {
            writeln!(f, "pours by what was drawn, a quarter of the sessions each: AUC, balanced (caught)")?;
        }
        for draw in &report.by_draw {
            write!(f, "  {:<20}", draw.quantity)?;
            for part in &draw.parts {
                let caught = part.caught.map_or("-".to_owned(), |part| format!("{:.0} %", 100.0 * part));
                let span = format!("{} to {}", short(part.from), short(part.to));
                write!(f, "{span:>17}: {:.2} {:.3} ({caught:>5})", part.auc, part.balanced)?;
            }
            writeln!(f)?;
        }
        if let Some(real) = &report.real {
            writeln!(
                f,
                "a real array: balanced {:.3}, AUC {:.3} of {} steps, {:.3} of {} recordings",
                real.balanced, real.auc, real.steps, real.recordings_auc, real.recordings
            )?;
        }
        writeln!(
            f,
            "all recordings: balanced {:.3}, {:.2} % right of {} steps, {} missed, {} false",
            report.all.balanced,
            100.0 * report.all.accuracy,
            report.all.steps,
            report.all.missed,
            report.all.false_steps
        )?;
        writeln!(f, "  {:<20}{} missed, {} false", "no look-back", without.missed, without.false_steps)?;
        write!(
            f,
            "  {:<20}{} of {} caught ({} early), {} late, {} said before, {} missed",
            "slips",
            events.slips.caught,
            events.slips.count,
            events.slips.early,
            events.slips.late,
            events.slips.said_before,
            events.slips.missed
        )?;
        if let (Some(p50), Some(p95)) = (events.latency_ms_p50, events.latency_ms_p95) {
            write!(f, "; {p50:.1} ms after macro onset, 95 % of those caught within {p95:.1} ms")?;
        }
        writeln!(f)?;
        for (doing, alarms) in &report.false_by {
            writeln!(
                f,
                "  {:<20}{:.1} an hour of {}: {} in {:.2} h, {} of them in micro slip",
                "false alarms",
                alarms.per_hour,
                doing.name(),
                alarms.count,
                alarms.hours,
                alarms.in_micro_slip
            )?;
        }
        rows(f, "by material, the worst first", &report.by_material)?;
        rows(f, "by session, the worst first", &report.by_session)
    }
}

/// Three digits.
fn short(value: f64) -> String {
    let places = (2.0 - value.abs().max(1e-3).log10().floor()).clamp(0.0, 5.0) as usize;
    format!("{value:.places$}")
}

fn rows(f: &mut fmt::Formatter<'_>, title: &str, by: &By) -> fmt::Result {
    writeln!(f, "{title}")?;
    for (name, Steps { steps, missed, false_steps, accuracy, balanced, .. }) in &by.0 {
        writeln!(
            f,
            "  {name:<20}balanced {balanced:.3}, {:.2} % of {steps} steps, {missed} missed, {false_steps} false",
            100.0 * accuracy
        )?;
    }
    Ok(())
}
