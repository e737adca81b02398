//! The default scene on a board: nothing lost, the glass kept, close to the oracle, in budget.

use super::{Bar, agreement};
use crate::board::Run;
use crate::report::CYCLES_PER_INSTRUCTION;
use crate::session::Outcome;

/// Slip distance and peak force may be so many times the oracle's.
const OF_ORACLE: f64 = 2.0;
/// The ticks may take so much of the core, per cent.
const LOAD_PERCENT: f64 = 20.0;

/// The bars of one run of the default scene. On the emulated board everything of it was kept, in `run`.
#[must_use]
pub fn bars(outcome: &Outcome, run: Option<&Run>) -> Vec<Bar> {
    let report = &outcome.report;
    let name = &report.scene;
    let mut bars = vec![
        Bar::new(
            format!("{name}: 60 s, no overrun, no dropped control tick"),
            format!(
                "{:.1} s, {} ticks, {} dropped, {} overruns",
                report.virtual_s, report.ticks.count, report.ticks.dropped, report.overruns
            ),
            report.virtual_s >= 60.0 && report.ticks.dropped == 0 && report.overruns == 0,
        ),
        Bar::new(
            format!("{name}: kept"),
            match report.slip.dropped {
                Some(true) => "it was dropped",
                Some(false) => "it was not dropped",
                None => "there was no object",
            },
            report.slip.dropped == Some(false),
        ),
        of_oracle(name, "slip distance", "mm", report.slip.distance_mm, report.oracle.distance_mm),
        of_oracle(name, "peak force", "N", report.grip.peak_force_n, report.oracle.peak_force_n),
    ];
    let Some(run) = run else {
        bars.push(Bar::skipped("emulated image: bit-exactness, load", "run on the host's logic"));
        return bars;
    };
    bars.push(Bar::noted(
        format!("{name}: how fast the board is emulated here"),
        format!("{:.1} s virtual in {:.1} s", report.virtual_s, report.wall_s),
    ));
    bars.push(agreement::bar(run));
    bars.push(load(outcome));
    bars
}

fn of_oracle(scene: &str, what: &str, unit: &str, run: Option<f64>, oracle: Option<f64>) -> Bar {
    let promise = format!("{scene}: {what} within {OF_ORACLE} times the oracle's");
    match (run, oracle) {
        (Some(run), Some(oracle)) => Bar::new(
            promise,
            format!("{run:.2} {unit} against {oracle:.2} {unit}"),
            run <= OF_ORACLE * oracle,
        ),
        _ => Bar::new(promise, "nothing was held", false),
    }
}

fn load(outcome: &Outcome) -> Bar {
    let promise = format!("ticks take under {LOAD_PERCENT} % of 100 MHz");
    let ticks = &outcome.report.ticks;
    let (Some(mean), Some(max), Some([low, high]), Some([core_low, core_high])) =
        (ticks.instructions_mean, ticks.instructions_max, ticks.load_percent, ticks.core_load_percent)
    else {
        return Bar::new(promise, "no instructions were counted", false);
    };
    let [few, many] = CYCLES_PER_INSTRUCTION;
    let figure = format!(
        "{mean:.0} instructions a tick, {max} at worst: {low:.1} to {high:.1} % at {few:.0} to {many:.0} cycles each \
         (interrupts and telemetry included: {core_low:.1} to {core_high:.1} %)"
    );
    Bar::new(promise, figure, high < LOAD_PERCENT)
}
