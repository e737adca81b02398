//! `tenax lint-image`: Clippy on the image's package, and no way to panic in its control.

use std::process::ExitCode;

use super::out;
use super::workspace;
use tenax_bench::budgets::Budgets;
use tenax_bench::image;
use tenax_bench::image::panics;

/// The chip besides the board's for which the image is compiled, to show what a port takes.
const PORT: &str = "stm32f446re";

pub fn main() -> anyhow::Result<ExitCode> {
    let root = workspace::root()?;
    image::clippy(&root)?;
    out::say!("image: no warnings")?;
    image::port(&root, PORT)?;
    out::say!("image: compiles for {PORT}, too")?;
    let elf = image::build(&root)?;
    let control = panics::check(&elf)?;
    out::say!(
        "image: none of the {} functions that the tick and {} handlers of interrupts reach can panic",
        control.functions,
        control.handlers
    )?;

    let budgets = Budgets::of_checkout()?;
    let sites = panics::sites(&elf)?;
    let mut kept = true;
    for (source, &count) in &sites {
        let most = budgets.panic_sites.get(source).copied().unwrap_or(0);
        kept &= count <= most;
        let passed = if count > most { "  PASSED" } else { "" };
        out::say!("image: {source:<16} {count:>4} places that may panic, at most {most}{passed}")?;
    }
    Ok(if kept { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
