//! Where an image may panic: nowhere between a frame's interrupt and the motor's bridge, and elsewhere in a number of places
//! that only falls.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::{Context, Result, ensure};
use object::{File, Object, ObjectSection};

use super::calls::Calls;
use super::pointers::calls_and_handlers;
use super::symbols::TICK;

/// What every panic ends in.
const PANIC: &str = "rust_begin_unwind";

/// What was found about control and the interrupts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Control {
    /// Functions that a frame or an interrupt may reach.
    pub functions: usize,
    /// Handlers of interrupts and faults.
    pub handlers: usize,
}

/// Reads an image's ELF file. Fails if control or an interrupt may panic, or call something that nobody knows; says by which way.
pub fn check(elf: &Path) -> Result<Control> {
    let bytes = std::fs::read(elf).with_context(|| format!("reading the image {}", elf.display()))?;
    let file = File::parse(&*bytes).context("not an ELF file")?;
    let (calls, handlers) = calls_and_handlers(&file)?;
    check_calls(&calls, &handlers).with_context(|| format!("the image {}", elf.display()))
}

/// What every handler leads to: the tick, and no panic.
fn check_calls(calls: &Calls, handlers: &BTreeSet<usize>) -> Result<Control> {
    let ticks = calls.named(|name| name == TICK);
    let panics = calls.named(|name| name.contains(PANIC));
    ensure!(!panics.is_empty(), "has no function {PANIC}: nothing can be said about panics");
    let reached = calls.reached(handlers);
    ensure!(ticks.iter().any(|tick| reached.contains_key(tick)), "no interrupt calls {TICK}");
    for &place in &panics {
        ensure!(!reached.contains_key(&place), "control may panic:\n    {}", calls.way(&reached, place));
    }
    Ok(Control { functions: reached.len(), handlers: handlers.len() })
}

/// The places from which an image may panic, by the crate that they are in: each has a `Location` among the constants.
/// Fails if the file cannot be read.
pub fn sites(elf: &Path) -> Result<BTreeMap<String, u64>> {
    let bytes = std::fs::read(elf).with_context(|| format!("reading the image {}", elf.display()))?;
    let file = File::parse(&*bytes).context("not an ELF file")?;
    let sections: Vec<(u64, &[u8])> = [".rodata", ".text", ".data"]
        .into_iter()
        .filter_map(|name| file.section_by_name(name))
        .map(|section| Ok((section.address(), section.data()?)))
        .collect::<Result<_>>()?;
    let text_at = |address: u64, length: usize| {
        let (base, bytes) =
            sections.iter().find(|(base, bytes)| (*base..*base + bytes.len() as u64).contains(&address))?;
        let from = (address - base) as usize;
        std::str::from_utf8(bytes.get(from..from.checked_add(length)?)?).ok()
    };
    let mut found = BTreeSet::new();
    for (_, bytes) in &sections {
        let words: Vec<u32> = bytes
            .chunks_exact(4)
            .map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]))
            .collect();
        for words in words.windows(4) {
            let &[address, length, line, column] = words else { continue };
            if !(4..300).contains(&length) || !(1..100_000).contains(&line) || !(1..1_000).contains(&column) {
                continue;
            }
            let Some(path) = text_at(address.into(), length as usize) else { continue };
            let path = path.trim_end_matches('\0');
            if path.ends_with(".rs") {
                found.insert((path, line, column));
            }
        }
    }
    let mut by_crate = BTreeMap::new();
    for (path, ..) in found {
        *by_crate.entry(crate_of(path)).or_default() += 1;
    }
    Ok(by_crate)
}

/// Whose source file this is.
fn crate_of(path: &str) -> String {
    let parts: Vec<&str> = path.split(['/', '\\']).collect();
    let behind = |name: &str| parts.iter().position(|part| *part == name).and_then(|n| parts.get(n + 1));
    if let Some(name) = behind("library") {
        return (*name).to_owned();
    }
    // What a build script generated: `PACKAGE-HASH/out/`.
    if let Some(built) =
        parts.iter().position(|part| *part == "out").and_then(|n| parts.get(n.checked_sub(1)?))
    {
        return built.rsplit_once('-').map_or(*built, |(package, _)| package).to_owned();
    }
    // `registry/src/`, a folder for the registry, and in it one for each version of a package; or `PACKAGE/src/`.
    let fetched = parts.windows(2).position(|two| two == ["registry", "src"]);
    let package = fetched
        .and_then(|n| parts.get(n + 3))
        .or_else(|| parts.iter().rev().skip_while(|part| **part != "src").nth(1));
    let package = package.copied().unwrap_or(path);
    let version = package
        .char_indices()
        .find(|&(n, c)| c == '-' && package[n + 1..].starts_with(|next: char| next.is_ascii_digit()));
    version.map_or(package, |(n, _)| &package[..n]).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::calls::Function;

    #[test]
    fn a_file_belongs_to_its_package() {
        for (path, package) in [
            ("logic/src/store/record.rs", "logic"),
            (
                "/home/me/.cargo/registry/src/somewhere-1949/embassy-stm32-0.6.0/src/rcc/mod.rs",
                "embassy-stm32",
            ),
            ("target/firmware/build/embassy-stm32-a2fcb9feec4b/out/_generated.rs", "embassy-stm32"),
            ("/rustc/59807616e1fa2540724bfbac14d7976d7e4a3860/library/core/src/option.rs", "core"),
            ("/usr/src/rustc/library/core/src/option.rs", "core"),
        ] {
            assert_eq!(crate_of(path), package, "{path}");
        }
    }

    /// Handlers of which one leads to the tick, what `more` adds, and from where the logic goes on.
    fn image(more: &[(&str, &[usize])]) -> Calls {
        let shape: [(&str, &[usize]); 5] = [
            ("TIM2", &[]),
            ("I2C3_ER", &[2]),
            ("tenax_control_tick", &[3]),
            ("logic", &[5]),
            ("rust_begin_unwind", &[]),
        ];
        let function = |&(name, calls): &(&str, &[usize])| Function {
            name: name.to_owned(),
            calls: calls.iter().copied().filter(|&place| place < 5 + more.len()).collect(),
            ..Function::default()
        };
        Calls(shape.iter().chain(more).map(function).collect())
    }

    #[test]
    fn a_panic_that_a_tick_or_an_interrupt_may_reach_is_found_with_its_way() {
        let check =
            |more: &[(&str, &[usize])], handlers| check_calls(&image(more), &BTreeSet::from_iter(handlers));
        assert_eq!(check(&[], vec![0, 1]).unwrap(), Control { functions: 4, handlers: 2 });
        // The control: what the tick does not reach may panic.
        let elsewhere = [("rest", &[][..]), ("telemetry", &[4][..])];
        assert_eq!(check(&elsewhere, vec![0, 1]).unwrap(), Control { functions: 5, handlers: 2 });
        // The same, in an interrupt.
        let error = check(&elsewhere, vec![0, 1, 6]).unwrap_err().to_string();
        assert_eq!(error, "control may panic:\n    telemetry\n    -> rust_begin_unwind");
        let error = check(&[("root", &[4])], vec![0, 1]).unwrap_err().to_string();
        assert!(
            error.contains("tenax_control_tick\n    -> logic\n    -> root\n    -> rust_begin_unwind"),
            "{error}"
        );
        assert_eq!(check(&[], vec![0]).unwrap_err().to_string(), "no interrupt calls tenax_control_tick");
    }
}
