//! The force array's network on a data set that nothing was learned or chosen from.
//!
//! The paper's task is pours alone. The goals (balanced 0.95, nine slips in ten within 50 ms at 20 false alarms an hour) are not reached
//! on honest draws: docs/array.md says where it fails and why.

use tenax_sim::array::network::Network;
use tenax_sim::array::pour::pour;
use tenax_sim::array::{Verdicts, readings};
use tenax_sim::labelled::Part;
use tenax_sim::scorer::Doing;

use super::{Bar, Goal};
use crate::dataset::{Dataset, Plan};

/// Another seed than the one that was learned from: 4 materials and the one outside of them.
const PLAN: Plan = Plan { seed: 4, sessions: 4 };
const GOALS: [Goal; 3] = [
    Goal { what: "array: pours of arrays never seen, balanced accuracy", goal: 0.95, held: 0.7 },
    Goal { what: "array: false steps in 2800", goal: 12.0, held: 29.0 },
    Goal { what: "array: false alarms an hour of pouring", goal: 20.0, held: 60.0 },
];

pub fn bars() -> anyhow::Result<Vec<Bar>> {
    let mut recordings = Dataset::make(PLAN, Some(Part::Test), &|_| {})?.recordings()?;
    recordings.retain(|recording| recording.doing == Doing::Pour);
    let network = Network::shipped();
    let said: Vec<Verdicts> = recordings.iter().map(|own| network.judge(&readings(&own.steps)).1).collect();
    let pour = pour(&recordings.iter().zip(&said).collect::<Vec<_>>()).unwrap_or_default();
    let by = format!(
        "{:.2} % right where 'never' has {:.2} %; {:.0} % of {} slips caught within 50 ms, {:.0} steps missed in 2800",
        100.0 * pour.accuracy,
        100.0 * (1.0 - pour.prevalence),
        100.0 * pour.caught_50ms.unwrap_or_default(),
        pour.slips,
        pour.missed_2800
    );
    let values = [pour.balanced, pour.false_2800, pour.false_per_hour];
    Ok(GOALS.into_iter().zip(values).map(|(goal, value)| Bar::short_of(goal, value, &by)).collect())
}
