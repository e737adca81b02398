//! `tenax lint-image`: Clippy on the image's package, no way to panic in its control, and how deep its stack may get.

use std::process::ExitCode;

use super::out;
use super::workspace;
use tenax_bench::budgets::Budgets;
use tenax_bench::image;
use tenax_bench::image::panics;
use tenax_bench::image::stack::Bound;

pub fn main() -> anyhow::Result<ExitCode> {
    let root = workspace::root()?;
    image::clippy(&root)?;
    out::say!("image: no warnings")?;
    let elf = image::build(&root)?;
    let control = panics::check(&elf)?;
    out::say!(
        "image: none of the {} functions that the tick and {} handlers of interrupts reach can panic",
        control.functions,
        control.handlers
    )?;

    let bound = Bound::of(&elf)?;
    out::say!("image: the stack takes at most {} of {} bytes, whatever runs:", bound.bytes, bound.free)?;
    for (level, (bytes, way)) in &bound.levels {
        let who = level.map_or("main program".to_owned(), |level| format!("priority {level}"));
        out::say!("image:   {bytes:>6} {who}\n    {}", way.join("\n    "))?;
    }

    let budgets = Budgets::of_checkout()?;
    let mut kept = true;
    let sites = panics::sites(&elf)?;
    if sites.is_empty() {
        out::say!("image: no place may panic")?;
    }
    for (source, &count) in &sites {
        let most = budgets.panic_sites.get(source).copied().unwrap_or(0);
        kept &= count <= most;
        let passed = if count > most { "  PASSED" } else { "" };
        out::say!("image: {source:<16} {count:>4} places that may panic, at most {most}{passed}")?;
    }
    Ok(if kept { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
