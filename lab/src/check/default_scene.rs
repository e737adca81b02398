//! The default scene on a board: nothing lost, the glass kept, close to the bound, in budget.

use super::{Bar, agreement};
use tenax_sim::board::Run;
use tenax_sim::report::CYCLES_PER_INSTRUCTION;
use tenax_sim::session::Outcome;

/// Peak force may be so many times the bound's.
const OF_BOUND: f64 = 1.5;
/// It may slide by half the pad, mm. The bound, which knows when the glass gets wet, does not let it slide at all.
const SLID_MM: f64 = 9.0;
/// The ticks may take so much of the core, per cent.
const LOAD_PERCENT: f64 = 20.0;

/// The bars of one run of the default scene. On the emulated board everything of it was kept, in `run`.
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
        slid(name, report.slip.distance_mm, report.bound.distance_mm),
        pressed(name, report.grip.peak_force_n, report.bound.peak_force_n),
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

fn slid(scene: &str, run: Option<f64>, bound: Option<f64>) -> Bar {
    let promise = format!("{scene}: it slides by no more than half the pad, {SLID_MM} mm");
    match (run, bound) {
        (Some(run), Some(bound)) => {
            Bar::new(promise, format!("{run:.2} mm; the bound {bound:.2} mm"), run <= SLID_MM)
        }
        _ => Bar::new(promise, "nothing was held", false),
    }
}

fn pressed(scene: &str, run: Option<f64>, bound: Option<f64>) -> Bar {
    let promise = format!("{scene}: peak force within {OF_BOUND} times the bound's");
    match (run, bound) {
        (Some(run), Some(bound)) => {
            Bar::new(promise, format!("{run:.2} N against {bound:.2} N"), run <= OF_BOUND * bound)
        }
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
