//! The scores for people.

use std::fmt::{self, Display};

use super::report::{By, Report, Steps};

/// Prints as text.
#[derive(Clone, Copy, Debug)]
pub struct Text<'a>(pub &'a Report);

impl Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let report = self.0;
        let Report { events, without_lookback: without, .. } = report;
        writeln!(
            f,
            "{} steps: {:.2} % right, {} missed, {} false",
            report.steps,
            100.0 * report.accuracy,
            report.missed,
            report.false_steps
        )?;
        writeln!(f, "  {:<20}{} missed, {} false", "no look-back", without.missed, without.false_steps)?;
        write!(f, "  {:<20}{} of {} caught", "slips", events.caught, events.count)?;
        if let (Some(p50), Some(p95)) = (events.latency_ms_p50, events.latency_ms_p95) {
            write!(f, ", {p50:.1} ms after their first step, 95 % of those within {p95:.1} ms")?;
        }
        writeln!(f, "\n  {:<20}{:.1} an hour", "false alarms", report.false_per_hour)?;
        rows(f, "by material, the worst first", &report.by_material)?;
        rows(f, "by session, the worst first", &report.by_session)
    }
}

fn rows(f: &mut fmt::Formatter<'_>, title: &str, by: &By) -> fmt::Result {
    writeln!(f, "{title}")?;
    for (name, Steps { steps, missed, false_steps, accuracy }) in &by.0 {
        writeln!(
            f,
            "  {name:<20}{:.2} % of {steps} steps, {missed} missed, {false_steps} false",
            100.0 * accuracy
        )?;
    }
    Ok(())
}
