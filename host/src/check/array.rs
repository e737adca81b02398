//! The force array's network on a data set that nothing was learned or chosen from: no worse than when it was shipped.
//!
//! The paper's task is pours alone. What a reviewer asks for (balanced 0.95, nine slips in ten within 50 ms at 20 false alarms an
//! hour) is not reached on honest draws: `docs/array-data.md` shows where it fails and why. These bars keep what there is.

use super::Bar;
use crate::dataset::session::Split;
use crate::dataset::{Dataset, Label, Plan};
use crate::evaluate::edges::{FALSE_2800_MAX, FALSE_PER_HOUR_MAX};
use crate::evaluate::network::Network;
use crate::evaluate::report::Report;
use crate::evaluate::{Verdicts, readings};
use crate::labelled::{self, library};

/// A data set of another seed than the one that was learned from: 4 materials and the one outside of them.
const PLAN: Plan = Plan { seed: 4, sessions: 4, label: Label::Truth };
/// Least balanced accuracy of its pours.
const BALANCED: f64 = 0.70;

/// The bars.
///
/// # Errors
/// If a scene cannot be made.
pub fn bars() -> anyhow::Result<Vec<Bar>> {
    let csv = Dataset::make_split(PLAN, Split::Test, &|_| {})?.csv()?;
    let name = "array_dataset.csv";
    let recordings = labelled::parse(csv.as_slice(), &library::choose(name.as_ref(), None)?, name)?;
    let network = Network::shipped();
    let said: Vec<Verdicts> =
        recordings.iter().map(|recording| network.judge(&readings(&recording.steps)).1).collect();
    let report = Report::new(&recordings, &said, &said);
    let pour = report.pour.unwrap_or_default();
    Ok(vec![
        Bar::new(
            format!("array: pours of arrays never seen, balanced accuracy at least {BALANCED}"),
            format!(
                "{:.3}, {:.2} % right where 'never' has {:.2} %; {:.0} % of {} slips caught within 50 ms",
                pour.balanced,
                100.0 * pour.accuracy,
                100.0 * (1.0 - pour.prevalence),
                100.0 * pour.caught_50ms.unwrap_or_default(),
                pour.slips
            ),
            pour.balanced >= BALANCED,
        ),
        Bar::new(
            format!(
                "array: at most {FALSE_2800_MAX} false steps in 2800 of them, {FALSE_PER_HOUR_MAX} false alarms an hour"
            ),
            format!(
                "{:.1}, and {:.0} missed; {:.0} false alarms an hour of pouring",
                pour.false_2800, pour.missed_2800, pour.false_per_hour
            ),
            pour.false_2800 <= FALSE_2800_MAX && pour.false_per_hour <= FALSE_PER_HOUR_MAX,
        ),
    ])
}
