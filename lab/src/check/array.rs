//! The force array's network on a data set that nothing was learned or chosen from.
//! The paper's task is pours alone. The goals (balanced 0.95, nine slips in ten within 50 ms at 20 false alarms an hour) are not reached
//! on honest draws: docs/array.md says where it fails and why.

use tenax_hal_shim::channel::{FRAME_HZ, FRAMES_PER_SLOW_FRAME};
use tenax_hal_shim::schedule::{Job, slot_of};
use tenax_logic::array::taxels::Taxels;
use tenax_logic::array::{ArrayDetector, shipped};
use tenax_sim::scorer::{Card, Doing, Stretch, Verdict};

use super::{Bar, Goal};
use crate::dataset::collect::Recording;
use crate::dataset::session::Part;
use crate::dataset::story::Story;
use crate::dataset::{Dataset, Plan};

/// Another seed than the one that was learned from: 4 materials and the one outside of them.
const PLAN: Plan = Plan { seed: 4, sessions: 4 };
const GOALS: [Goal; 3] = [
    Goal { what: "array: pours of arrays never seen, balanced accuracy", goal: 0.95, held: 0.7 },
    Goal { what: "array: false steps in 2800", goal: 12.0, held: 29.0 },
    Goal { what: "array: false alarms an hour of pouring", goal: 20.0, held: 60.0 },
];

/// Steps by whether they slip, and by whether slip is said of them; and the slips.
#[derive(Default)]
struct Pours {
    steps: [[f64; 2]; 2],
    card: Card,
}

impl Pours {
    fn take(&mut self, pour: &Recording) {
        let (mut detector, mut taxels) = (ArrayDetector::new(&shipped::MODEL), Taxels::default());
        // The array begins in the slot behind the last reading.
        let slots = slot_of(Job::MlpDecides) + 1 - slot_of(Job::ArrayBegins);
        let decided_after_s = f64::from(slots) / f64::from(FRAME_HZ);
        let mut verdicts = Vec::new();
        for step in &pour.steps {
            for (element, &sample) in step.samples.iter().enumerate() {
                let _change = taxels.read(element, sample);
            }
            let said = detector.push(taxels.reading()).slip;
            self.steps[usize::from(step.slips)][usize::from(said)] += 1.0;
            Verdict::go_on(&mut verdicts, step.t_s + decided_after_s, said);
        }
        let ends_s = [pour.steps.first(), pour.steps.last()].map(|step| step.map_or(0.0, |step| step.t_s));
        let step_s = f64::from(FRAMES_PER_SLOW_FRAME) / f64::from(FRAME_HZ);
        let whole = Stretch { from_s: ends_s[0], to_s: ends_s[1] + step_s, doing: Doing::Pour };
        self.card.add(&Card::of(&pour.spans, &verdicts, &[whole]));
    }
}

pub fn bars() -> anyhow::Result<Vec<Bar>> {
    let mut pours = Pours::default();
    let dataset = Dataset::make(PLAN, Some(Part::Test), &|_| {})?;
    let recordings = dataset.sessions.iter().flat_map(|(_, recordings)| recordings);
    recordings.filter(|own| own.story == Story::Pour).for_each(|own| pours.take(own));
    let Pours { steps: [[quiet, alarmed], [missed, seen]], card } = pours;
    let (still, slips) = (quiet + alarmed, missed + seen);
    let (all, per_hour) = (still + slips, card.false_alarms.per_hour);
    let by = format!(
        "{:.2} % right where 'never' has {:.2} %; {:.0} % of {} slips caught within 50 ms, {:.0} steps missed in 2800",
        100.0 * (quiet + seen) / all,
        100.0 * still / all,
        100.0 * card.slips.caught as f64 / card.slips.count as f64,
        card.slips.count,
        2_800.0 * missed / all
    );
    let values = [(seen / slips + quiet / still) / 2.0, 2_800.0 * alarmed / all, per_hour];
    let bars = GOALS.into_iter().zip(values).zip([by.as_str(), "", ""]);
    Ok(bars.map(|((goal, value), by)| Bar::short_of(goal, value, by)).collect())
}
