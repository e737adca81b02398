//! Worlds and an hour of disturbance that are drawn, of a seed on which nothing is chosen. Their causal oracle knows slip, not the future.

use tenax_sim::drawn::{Report, scores};

use super::{Bar, Goal};
use crate::evaluate::disturbed::{self, MINUTES};

/// Seeds below 1000 are for choosing.
const SEED: u64 = 1_000;
const WORLDS: u32 = 200;
const GOALS: [Goal; 4] = [
    Goal { what: "drawn worlds: part lost where a causal oracle keeps", goal: 0.015, held: 0.04 },
    Goal { what: "drawn worlds: peak force over the needed one, median", goal: 1.25, held: 1.3 },
    Goal { what: "drawn worlds: peak force over the needed one, 95 % of the worlds", goal: 1.8, held: 2.4 },
    Goal { what: "drawn worlds: force without need, N a world", goal: 0.3, held: 0.7 },
];
/// Of one hour; `tenax evaluate disturbed --hours 48` is the night's.
const NEEDLESS: Goal =
    Goal { what: "drawn hour of disturbance: closings without need", goal: 0.0, held: 20.0 };

pub fn hour() -> anyhow::Result<Vec<Bar>> {
    let hour = disturbed::evaluate(SEED, 60 / MINUTES, &|_| {})?;
    let [a_day, low, high] = hour.without_need_a_day;
    let by = format!(
        "{a_day:.0} a day of holding, {low:.0} to {high:.0} by 95 %; {} closings, {} slips, {} of {} holds lost in {:.2} h",
        hour.closings, hour.slips, hour.lost, hour.holds, hour.hours
    );
    Ok(vec![Bar::short_of(NEEDLESS, f64::from(hour.without_need), by)])
}

pub fn bars() -> anyhow::Result<Vec<Bar>> {
    let total = Report::new(SEED, &scores(None, SEED, WORLDS, &|_| {})?)?.total;
    let known = Option::unwrap_or_default;
    let values = [
        total.lost_where_oracle_keeps,
        known(total.peak_over_needed_median),
        known(total.peak_over_needed_p95),
        total.without_need_n,
    ];
    let slid = [total.slid_mm_p95, total.slid_mm_p95_oracle].map(known);
    let by =
        format!("{WORLDS} of seed {SEED}; slid {:.1} mm, the oracle {:.1} mm, in 95 %", slid[0], slid[1]);
    let mut bars: Vec<Bar> = GOALS
        .into_iter()
        .zip(values)
        .zip([by.as_str(), "", "", ""])
        .map(|((goal, value), by)| Bar::short_of(goal, value, by))
        .collect();
    let ticks = total.reflex_while_active;
    bars.push(Bar::new(
        "drawn worlds: ticks of the reflex while a muscle is active",
        ticks.to_string(),
        "0",
        ticks == 0,
    ));
    Ok(bars)
}
