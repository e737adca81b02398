//! What an image's symbol table says: where its tick and its commands are, and which memory is nobody's but the stack's.

use std::ops::Range;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use object::{File, Object, ObjectSection, ObjectSymbol};

const TICK: &str = "tenax_control_tick";
const COMMAND: &str = "tenax_control_command";

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbols {
    pub tick: u64,
    pub after_tick: u64,
    pub command: u64,
    pub stack: Range<u64>,
}

impl Symbols {
    pub fn read(elf: &Path) -> Result<Self> {
        let bytes = std::fs::read(elf).with_context(|| format!("reading the image {}", elf.display()))?;
        let symbols = File::parse(&*bytes).context("not an ELF file").and_then(|file| Self::of(&file));
        symbols.with_context(|| format!("the image {}", elf.display()))
    }

    fn of(file: &File<'_>) -> Result<Self> {
        let stack = address_of(file, "__sheap")?..address_of(file, "_stack_start")?;
        ensure!(stack.start < stack.end, "leaves no RAM for the stack");
        let (tick, command) = (entry(file, TICK)?, entry(file, COMMAND)?);
        let text = file.section_by_name(".text").context("has no .text section")?;
        match return_addresses(text.data()?, text.address(), tick)[..] {
            [after_tick] => Ok(Self { tick, after_tick, command, stack }),
            [] => bail!("{TICK} is never called"),
            _ => bail!("{TICK} is called from more than one place: its cost cannot be told"),
        }
    }
}

fn entry(file: &File<'_>, name: &str) -> Result<u64> {
    // Bit 0 of a function's address says that it is Thumb code.
    Ok(address_of(file, name)? & !1)
}

fn address_of(file: &File<'_>, name: &str) -> Result<u64> {
    file.symbols()
        .find(|symbol| symbol.name() == Ok(name))
        .map(|symbol| symbol.address())
        .with_context(|| format!("has no symbol `{name}`"))
}

/// Return addresses of the calls of `target` in `text`, which begins at `base`: BL in encoding T1 (ARMv7-M manual, A7.7.18).
fn return_addresses(text: &[u8], base: u64, target: u64) -> Vec<u64> {
    let found = text.windows(4).enumerate().step_by(2).filter_map(|(offset, bytes)| {
        let after = base + offset as u64 + 4;
        let first = u16::from_le_bytes([bytes[0], bytes[1]]);
        let second = u16::from_le_bytes([bytes[2], bytes[3]]);
        let is_call = first >> 11 == 0b11110 && second & 0xD000 == 0xD000;
        (is_call && after.wrapping_add_signed(call_offset(first, second)) == target).then_some(after)
    });
    found.collect()
}

/// Offset of a BL's target from the instruction behind it: S:I1:I2:imm10:imm11:0, where I1 and I2 are NOT(J1 ^ S), NOT(J2 ^ S).
fn call_offset(first: u16, second: u16) -> i64 {
    let bit = |word: u16, n: u16| i64::from(word >> n & 1);
    let sign = bit(first, 10);
    let high = (1 ^ bit(second, 13) ^ sign) << 23 | (1 ^ bit(second, 11) ^ sign) << 22;
    let low = i64::from(first & 0x3FF) << 12 | i64::from(second & 0x7FF) << 1;
    high | low | -(sign << 24)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_call_is_found() {
        let call_next = [0x00, 0xF0, 0x00, 0xF8];
        let mut text = call_next.to_vec();
        text.extend([0x70, 0x47]);
        // `b.w` to the same place is no call.
        text.extend([0xFF, 0xF7, 0xFD, 0xBF]);
        assert_eq!(return_addresses(&text, 0x100, 0x104), [0x104]);
        assert!(return_addresses(&text, 0x100, 0x200).is_empty());
    }
}
