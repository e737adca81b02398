//! `tenax size`: what the image takes of the chip, beside its budgets.

use std::path::Path;
use std::process::ExitCode;

use super::out;
use super::progress::Progress;
use super::workspace;
use tenax_bench::budgets::{Budgets, Line};
use tenax_bench::image;
use tenax_bench::image::size::{FLASH_BYTES, RAM_BYTES, Size};
use tenax_bench::image::stack::Bound;
use tenax_bench::report::Report;
use tenax_bench::session::{self, Board};

/// Flash, RAM, worst stack and instructions a tick of the image, beside their budgets.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Fail if a budget (budgets.toml) is passed, or could not be measured
    #[arg(long)]
    check: bool,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let root = workspace::root()?;
    let board = Board::emulated(&root)?;
    let file = session::load_scene(session::DEFAULT_SCENE)?;
    let progress = Progress::new(&format!("scene {}", file.name), file.duration_s());
    let report = session::scene(&file, 1, &board, &mut |s| progress.at(s))?.report;
    drop(progress);
    let lines = lines(&root, &report)?;
    out::unless_closed(lines.iter().try_for_each(|line| out::say!("{line}")))?;
    let kept = lines.iter().all(Line::is_kept);
    Ok(if kept || !args.check { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Every budget, beside what the image takes and what a run of the default scene on it took. Fails if the image cannot be built or read.
pub fn lines(root: &Path, report: &Report) -> anyhow::Result<Vec<Line>> {
    let budgets = Budgets::of_checkout()?;
    let elf = image::build(root)?;
    let (size, stack) = (Size::read(&elf)?, Bound::of(&elf)?);
    let painted = report.stack_bytes.unwrap_or(0);
    anyhow::ensure!(
        painted <= stack.bytes,
        "the stack took {painted} bytes, more than {}, its bound",
        stack.bytes
    );
    let bytes = |what, measured, budget, of| Line { what, unit: "bytes", measured, budget, of: Some(of) };
    let instructions =
        |what, measured, budget| Line { what, unit: "instructions", measured, budget, of: None };
    let mean = |mean: Option<f64>| mean.map(|mean| mean.round() as u64);
    let array = array_costs(root)?;
    let of_array = |what, name: &str, budget| {
        instructions(what, array.iter().find(|(own, _)| own == name).map(|(_, most)| *most), budget)
    };
    Ok(vec![
        bytes("flash", Some(size.flash), budgets.flash_bytes, FLASH_BYTES),
        bytes("RAM, variables", Some(size.ram), budgets.ram_bytes, RAM_BYTES),
        bytes("worst stack", report.stack_bytes, budgets.stack_bytes, RAM_BYTES - size.ram),
        bytes("stack, by calls", Some(stack.bytes), stack.free, RAM_BYTES - size.ram),
        instructions("tick, mean", mean(report.load.tick_instructions_mean), budgets.tick_instructions_mean),
        instructions("tick, worst", report.ticks.instructions_max, budgets.tick_instructions_max),
        instructions(
            "period, mean",
            mean(report.load.period_instructions_mean),
            budgets.period_instructions_mean,
        ),
        of_array("array covariance", "covariance", budgets.array_covariance_instructions),
        of_array("array spectrum", "spectrum", budgets.array_spectrum_instructions),
        of_array("112-32-16-1", "mlp_structure_8_1", budgets.array_network_instructions),
        of_array("array, all of it", "slow_frame", budgets.array_slow_frame_instructions),
    ])
}

/// What each kernel of the array detector costs at its worst.
#[cfg(feature = "emulator")]
fn array_costs(root: &Path) -> anyhow::Result<Vec<(String, u64)>> {
    let costs = tenax_bench::board::emulated::kernels::costs(&image::build_kernels(root)?)?;
    Ok(costs.into_iter().map(|cost| (cost.name, cost.most)).collect())
}

/// Not measured: there is no core to count on.
#[cfg(not(feature = "emulator"))]
fn array_costs(_root: &Path) -> anyhow::Result<Vec<(String, u64)>> {
    Ok(Vec::new())
}
