//! Where an image may panic: nowhere between a frame's interrupt and the motor's bridge, and elsewhere in a number of places
//! that only falls.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::{Context, Result, ensure};
use object::{File, Object, ObjectSection};

use super::calls::Calls;
use super::symbols::TICK;

/// What every panic ends in.
const PANIC: &str = "rust_begin_unwind";
/// The interrupts of a frame: DMA has filled it, or it did not come in time; and the executor of control.
const INTERRUPTS: [&str; 3] = ["DMA2_STREAM0", "TIM2", "I2C3_ER"];
/// What an interrupt calls through a task's waker, and a task when it registers one.
const WAKER: &str = "embassy_executor3raw5waker";
/// Names of functions that may call through a pointer: there it is a waker, or the executor that polls a task.
const MAY_CALL_POINTERS: [&str; 5] =
    ["DMA2_STREAM0", "TIM2", "I2C3_ER", "tenax_firmware", "embassy_executor"];

/// What was found about control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Control {
    /// Functions that a frame may reach.
    pub functions: usize,
}

/// Reads an image's ELF file. Fails if control may panic, or call something that nobody knows; says by which way.
pub fn check(elf: &Path) -> Result<Control> {
    let bytes = std::fs::read(elf).with_context(|| format!("reading the image {}", elf.display()))?;
    let file = File::parse(&*bytes).context("not an ELF file")?;
    check_calls(&Calls::of(&file)?).with_context(|| format!("the image {}", elf.display()))
}

/// From the frame's interrupts, everything that leads to the tick, and what that leads to.
fn check_calls(calls: &Calls) -> Result<Control> {
    let ticks = calls.named(|name| name == TICK);
    ensure!(!ticks.is_empty(), "has no function {TICK}");
    let mut roots = calls.callers(&ticks);
    ensure!(!roots.is_empty(), "{TICK} is never called");
    for interrupt in INTERRUPTS {
        let own = calls.named(|name| name == interrupt);
        ensure!(!own.is_empty(), "has no interrupt {interrupt}");
        roots.extend(own);
    }
    roots.extend(calls.named(|name| name.contains(WAKER)));
    let panics = calls.named(|name| name.contains(PANIC));
    ensure!(!panics.is_empty(), "has no function {PANIC}: nothing can be said about panics");

    let reached = calls.reached(&roots);
    for &place in reached.keys() {
        let own = &calls.0[place];
        let way = || calls.way(&reached, place);
        ensure!(!panics.contains(&place), "control may panic:\n    {}", way());
        let may = MAY_CALL_POINTERS.iter().any(|part| own.name.contains(part));
        ensure!(may || own.indirect == 0, "control calls through a pointer:\n    {}", way());
    }
    Ok(Control { functions: reached.len() })
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

    fn image(more: &[(&str, &[usize], usize)]) -> Calls {
        let shape: [(&str, &[usize], usize); 8] = [
            ("DMA2_STREAM0", &[], 1),
            ("TIM2", &[], 1),
            ("I2C3_ER", &[], 1),
            ("_ZN16embassy_executor3raw4poll", &[4], 1),
            ("tenax_control_tick", &[7], 0),
            ("_ZN16embassy_executor3raw5waker4wake", &[], 0),
            ("rust_begin_unwind", &[], 0),
            ("logic", &[8], 0),
        ];
        let function = |&(name, calls, indirect): &(&str, &[usize], usize)| Function {
            name: name.to_owned(),
            calls: calls.iter().copied().filter(|&place| place < 8 + more.len()).collect(),
            indirect,
            ..Function::default()
        };
        Calls(shape.iter().chain(more).map(function).collect())
    }

    #[test]
    fn a_panic_or_an_unknown_call_that_a_tick_may_reach_is_found_with_its_way() {
        assert_eq!(check_calls(&image(&[])).unwrap(), Control { functions: 7 });
        // The control: what the tick does not reach may do all of it.
        let elsewhere = [("rest", &[][..], 0), ("telemetry", &[6][..], 1)];
        assert_eq!(check_calls(&image(&elsewhere)).unwrap(), Control { functions: 8 });
        for (function, says) in [
            (("root", &[6][..], 0), "control may panic"),
            (("root", &[][..], 1), "control calls through a pointer"),
        ] {
            let error = check_calls(&image(&[function])).unwrap_err().to_string();
            assert!(
                error.starts_with(says) && error.contains("tenax_control_tick\n    -> logic\n    -> root"),
                "{error}"
            );
        }
    }
}
