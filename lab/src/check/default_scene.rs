//! The default scene on a board: nothing lost, the glass kept, close to the bound, within the budgets of `budgets.toml`.

use std::path::Path;

use tenax_sim::board::Run;
use tenax_sim::board::agreement::Agreement;
use tenax_sim::budgets::Budgets;
use tenax_sim::image::size::Size;
use tenax_sim::live::Use;
use tenax_sim::report::{CYCLES_PER_INSTRUCTION, Report};
use tenax_sim::session::{self, Board};

use super::{Bar, Verdict};

/// Peak force, times the bound's.
const OF_BOUND: f64 = 1.5;
/// Slid: half the pad, mm. The bound knows when the glass gets wet and does not let it slide at all.
const SLID_MM: f64 = 9.0;
const LOAD_PERCENT: f64 = 20.0;
/// 1 % of the core, 1 MHz: 100 uA by DS10314 (features, peripherals off) at 3.3 V, uJ/s.
const PERCENT_UJ_S: f64 = 100.0 * 3.3;

/// The bars of one run; those of the image where `image` is the emulated board's ELF file. Fails if the board cannot be run.
pub fn bars(board: &Board, image: Option<&Path>) -> anyhow::Result<Vec<Bar>> {
    let file = session::load_scene(session::DEFAULT_SCENE)?;
    let mut run = Run::default();
    let outcome = session::scene_served(&file, 1, board, Use::default(), &mut run, &mut |_| {})?;
    run.summary = outcome.run.clone();
    let report = &outcome.report;
    let name = &report.scene;
    let mut bars = vec![
        Bar::new(
            format!("{name}: 60 s, nothing lost"),
            format!(
                "{:.1} s, {} ticks, {} dropped, {} overruns",
                report.virtual_s, report.ticks.count, report.ticks.dropped, report.overruns
            ),
            "none",
            report.virtual_s >= 60.0 && report.ticks.dropped == 0 && report.overruns == 0,
        ),
        Bar::new(
            format!("{name}: kept"),
            match report.slip.dropped {
                Some(true) => "dropped",
                Some(false) => "not dropped",
                None => "no object",
            },
            "",
            report.slip.dropped == Some(false),
        ),
        beside_bound(
            format!("{name}: slid, mm"),
            [report.slip.distance_mm, report.bound.distance_mm],
            ("half the pad, 9 mm", &|_| SLID_MM),
        ),
        beside_bound(
            format!("{name}: peak force, N"),
            [report.grip.peak_force_n, report.bound.peak_force_n],
            ("1.5 times the bound's", &|bound| OF_BOUND * bound),
        ),
    ];
    let Some(image) = image else {
        bars.push(Bar::unjudged("emulated image", "run on the host's logic", Verdict::Skipped));
        return Ok(bars);
    };
    let agreement = Agreement::of(&run);
    bars.push(Bar::unjudged(
        format!("{name}: speed of the emulated board"),
        format!("{:.1} s virtual in {:.1} s", report.virtual_s, report.wall_s),
        Verdict::Clock,
    ));
    bars.push(Bar::new(
        "image = host logic, bit for bit, every detector output and command",
        agreement.to_string(),
        "",
        agreement.holds(),
    ));
    bars.push(load(report));
    bars.extend(budgets(image, report)?);
    Ok(bars)
}

/// A quantity and the bound's, against a limit that may depend on the bound's.
fn beside_bound(
    promise: String,
    [run, bound]: [Option<f64>; 2],
    (words, limit): (&str, &dyn Fn(f64) -> f64),
) -> Bar {
    match (run, bound) {
        (Some(run), Some(bound)) => {
            Bar::new(promise, format!("{run:.2}; the bound {bound:.2}"), words, run <= limit(bound))
        }
        _ => Bar::new(promise, "nothing was held", words, false),
    }
}

fn load(report: &Report) -> Bar {
    let (promise, limit) = ("load of the 100 MHz core by the ticks", format!("{LOAD_PERCENT} %"));
    let ticks = &report.ticks;
    let (Some(mean), Some(max), Some([low, high]), Some([core_low, core_high])) =
        (ticks.instructions_mean, ticks.instructions_max, ticks.load_percent, ticks.core_load_percent)
    else {
        return Bar::new(promise, "no instructions were counted", limit, false);
    };
    let [few, many] = CYCLES_PER_INSTRUCTION;
    let measured = format!(
        "{mean:.0} instructions a tick, {max} at worst: {low:.1} to {high:.1} % at {few:.0} to {many:.0} cycles each \
         (interrupts and telemetry included: {core_low:.1} to {core_high:.1} %, {:.0} to {:.0} uJ/s by DS10314's 100 uA/MHz)",
        PERCENT_UJ_S * core_low,
        PERCENT_UJ_S * core_high
    );
    Bar::new(promise, measured, limit, high < LOAD_PERCENT)
}

/// Every budget, beside the size of the image and the counts of a run. Fails if the image cannot be read.
fn budgets(image: &Path, report: &Report) -> anyhow::Result<[Bar; 6]> {
    let budgets = Budgets::of_checkout()?;
    let size = Size::read(image)?;
    let mean = |mean: Option<f64>| mean.map(|mean| mean.round() as u64);
    let load = &report.load;
    Ok([
        ("flash, bytes", Some(size.flash), budgets.flash_bytes),
        ("RAM, variables, bytes", Some(size.ram), budgets.ram_bytes),
        ("worst stack, bytes", report.stack_bytes, budgets.stack_bytes),
        ("tick, mean, instructions", mean(load.tick_instructions_mean), budgets.tick_instructions_mean),
        ("tick, worst, instructions", report.ticks.instructions_max, budgets.tick_instructions_max),
        ("period, mean, instructions", mean(load.period_instructions_mean), budgets.period_instructions_mean),
    ]
    .map(|(what, measured, budget)| {
        let kept = measured.is_some_and(|measured| measured <= budget);
        let measured = measured.map_or("not measured".to_owned(), |measured| measured.to_string());
        Bar::new(what, measured, budget.to_string(), kept)
    }))
}
