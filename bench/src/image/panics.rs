//! Where an image may panic: nowhere between a frame's interrupt and the motor's bridge, and elsewhere in a number of places
//! that only falls.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::{Context, Result, ensure};
use object::{File, Object, ObjectSection};

use super::calls::{Calls, Function};
use super::symbols::TICK;

/// What every panic ends in.
const PANIC: &str = "rust_begin_unwind";
/// Where a Cortex-M finds its exceptions: after the stack and the start, which are no interrupts.
const VECTORS: &str = ".vector_table";
/// An image of ours has so many handlers at least: of faults, of the frame, the line, the bus, the supply.
const HANDLERS_MIN: usize = 10;
/// What an interrupt calls through a task's waker, and a task when it registers one.
const WAKER: &str = "embassy_executor3raw5waker";
/// Names of functions that may call through a pointer: there it is a waker, or the executor that polls a task.
const MAY_CALL_POINTERS: [&str; 7] =
    ["DMA1_STREAM", "DMA2_STREAM0", "TIM2", "USART2", "I2C3_ER", "tenax_firmware", "embassy_executor"];

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
    let vectors = file.section_by_name(VECTORS).context("has no vectors")?.data()?;
    let calls = Calls::of(&file)?;
    let handlers = handlers(&calls, vectors);
    ensure!(
        handlers.len() >= HANDLERS_MIN,
        "has {} handlers of interrupts: some were not found",
        handlers.len()
    );
    check_calls(&calls, handlers).with_context(|| format!("the image {}", elf.display()))
}

/// The functions that the table of vectors names, but for the start.
fn handlers(calls: &Calls, vectors: &[u8]) -> BTreeSet<usize> {
    let word = |bytes: &[u8]| bytes.try_into().map_or(0, u32::from_le_bytes);
    let at: BTreeSet<u64> =
        vectors.chunks_exact(4).skip(2).map(|bytes| u64::from(word(bytes) & !1)).collect();
    let is_named = |own: &Function| own.instructions.first().is_some_and(|first| at.contains(first));
    calls.0.iter().enumerate().filter(|(_, own)| is_named(own)).map(|(place, _)| place).collect()
}

/// From every handler, and from everything that leads to the tick, what they lead to.
fn check_calls(calls: &Calls, handlers: BTreeSet<usize>) -> Result<Control> {
    let ticks = calls.named(|name| name == TICK);
    ensure!(!ticks.is_empty(), "has no function {TICK}");
    let mut roots = calls.callers(&ticks);
    ensure!(!roots.is_empty(), "{TICK} is never called");
    let found = handlers.len();
    roots.extend(handlers);
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
    Ok(Control { functions: reached.len(), handlers: found })
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
    fn handlers_are_those_of_the_table_but_for_stack_and_start() {
        let mut calls = image(&[]);
        for (place, own) in calls.0.iter_mut().enumerate() {
            own.instructions = vec![0x0800_0100 + 0x10 * place as u64];
        }
        let table = [0x2002_0000, 0x0800_0131, 0x0800_0101, 0, 0x0800_0121_u32].map(u32::to_le_bytes);
        assert_eq!(handlers(&calls, table.as_flattened()), BTreeSet::from([0, 2]));
    }

    #[test]
    fn a_panic_or_an_unknown_call_that_a_tick_may_reach_is_found_with_its_way() {
        let handlers = || BTreeSet::from([0, 1, 2]);
        let found = |functions| Control { functions, handlers: 3 };
        assert_eq!(check_calls(&image(&[]), handlers()).unwrap(), found(7));
        // The control: what the tick does not reach may do all of it.
        let elsewhere = [("rest", &[][..], 0), ("telemetry", &[6][..], 1)];
        assert_eq!(check_calls(&image(&elsewhere), handlers()).unwrap(), found(8));
        // The same, in an interrupt.
        let error = check_calls(&image(&elsewhere), BTreeSet::from([0, 1, 2, 9])).unwrap_err().to_string();
        assert!(error.starts_with("control may panic:\n    telemetry\n"), "{error}");
        for (function, says) in [
            (("root", &[6][..], 0), "control may panic"),
            (("root", &[][..], 1), "control calls through a pointer"),
        ] {
            let error = check_calls(&image(&[function]), handlers()).unwrap_err().to_string();
            assert!(
                error.starts_with(says) && error.contains("tenax_control_tick\n    -> logic\n    -> root"),
                "{error}"
            );
        }
    }
}
