//! Who calls whom in an image, read from its instructions.
//!
//! Only branches matter, so only they are decoded (ARMv7-M manual, A7.7): everything else is skipped by its length, and
//! what is data between the code by the mapping symbols that the linker leaves (ELF for the Arm Architecture, 5.5.5).

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::ops::Range;

use anyhow::{Context, Result};
use object::{File, Object, ObjectSection, ObjectSymbol, SymbolKind};

use super::stack::taken;

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Function {
    /// Its name, as the linker knows it.
    pub name: String,
    pub bytes: u64,
    /// Where its instructions are.
    pub instructions: Vec<u64>,
    /// Functions that it calls or goes on in, by their place.
    pub calls: BTreeSet<usize>,
    /// Calls whose target is in a register: nobody knows where they lead.
    pub indirect: usize,
    /// Bytes of the stack that its instructions take, all of them. None where that is not known.
    pub stack: Option<u64>,
}

/// What an instruction does besides going on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// Nothing.
    On,
    /// A branch or a call, so far from the instruction behind it (of 16 bits; of 32, from its second half's end).
    To(i64),
    /// To where a register says.
    Indirect,
}

/// The functions of an image, in the order of their addresses.
#[derive(Clone, Debug, Default)]
pub struct Calls(pub Vec<Function>);

impl Calls {
    /// Reads them from an ELF file. Fails if it has no code, or none of it has a name.
    pub fn of(file: &File<'_>) -> Result<Self> {
        let text = file.section_by_name(".text").context("has no .text section")?;
        let (base, code) = (text.address(), text.data()?);
        let end = base + code.len() as u64;
        let (mut starts, mut data) = (BTreeMap::new(), BTreeMap::new());
        for symbol in file.symbols().filter(|symbol| (base..end).contains(&symbol.address())) {
            let name = symbol.name().unwrap_or_default();
            match name.get(..2) {
                Some("$d") => _ = data.insert(symbol.address(), true),
                Some("$t") => _ = data.insert(symbol.address(), false),
                _ if symbol.kind() == SymbolKind::Text => {
                    // Bit 0 says that it is Thumb code. Of several names any will do.
                    starts.insert(symbol.address() & !1, (name.to_owned(), symbol.size()));
                }
                _ => {}
            }
        }
        let mut calls = Self::default();
        let places: Vec<u64> = starts.keys().copied().collect();
        for (place, (&start, (name, size))) in starts.iter().enumerate() {
            let next = places.get(place + 1).copied().unwrap_or(end);
            // The linker fills up to the next one with bytes that would read as branches. Assembler's symbols may have no size.
            let until = if *size == 0 { next } else { next.min(start + size) };
            let mut function =
                Function { name: name.clone(), bytes: until - start, stack: Some(0), ..Function::default() };
            let is_data = |at: u64| data.range(..=at).next_back().is_some_and(|(_, &is_data)| is_data);
            function.read(code, base, start..until, &places, is_data);
            calls.0.push(function);
        }
        anyhow::ensure!(!calls.0.is_empty(), "has no function with a name");
        Ok(calls)
    }

    /// The places of the functions whose name this accepts.
    pub fn named(&self, accepts: impl Fn(&str) -> bool) -> BTreeSet<usize> {
        self.0.iter().enumerate().filter(|(_, own)| accepts(&own.name)).map(|(place, _)| place).collect()
    }

    /// Everything that calls one of these, and everything that calls that.
    pub fn callers(&self, of: &BTreeSet<usize>) -> BTreeSet<usize> {
        let mut all = BTreeSet::new();
        let mut next: VecDeque<usize> = of.iter().copied().collect();
        while let Some(callee) = next.pop_front() {
            for (place, own) in self.0.iter().enumerate() {
                if own.calls.contains(&callee) && all.insert(place) {
                    next.push_back(place);
                }
            }
        }
        all
    }

    /// Everything that is reached from `roots`, each with who called it first; of a root, itself.
    pub fn reached(&self, roots: &BTreeSet<usize>) -> BTreeMap<usize, usize> {
        let mut by: BTreeMap<usize, usize> = roots.iter().map(|&root| (root, root)).collect();
        let mut next: VecDeque<usize> = roots.iter().copied().collect();
        while let Some(caller) = next.pop_front() {
            for &callee in &self.0[caller].calls {
                by.entry(callee).or_insert_with(|| {
                    next.push_back(callee);
                    caller
                });
            }
        }
        by
    }

    /// The way to a function that was reached, from its root.
    pub fn way(&self, reached: &BTreeMap<usize, usize>, to: usize) -> String {
        let mut way = vec![to];
        while let Some(&by) = way.last().and_then(|last| reached.get(last))
            && Some(&by) != way.last()
        {
            way.push(by);
        }
        let names: Vec<&str> = way.iter().rev().map(|&place| self.0[place].name.as_str()).collect();
        names.join("\n    -> ")
    }
}

impl Function {
    fn read(
        &mut self,
        code: &[u8],
        base: u64,
        span: Range<u64>,
        places: &[u64],
        is_data: impl Fn(u64) -> bool,
    ) {
        let half = |at: u64| {
            let bytes = code.get((at - base) as usize..)?.first_chunk::<2>()?;
            Some(u16::from_le_bytes(*bytes))
        };
        let mut at = span.start;
        while at < span.end {
            let Some(first) = half(at) else { break };
            if is_data(at) {
                at += 2;
                continue;
            }
            let wide = first >> 11 >= 0b11101;
            self.instructions.push(at);
            let second = if wide { half(at + 2).unwrap_or(0) } else { 0 };
            let step = if wide { step_wide(first, second) } else { step_narrow(first) };
            self.stack = self.stack.zip(taken(first, second)).map(|(all, more)| all + more);
            match step {
                Step::On => {}
                Step::Indirect => self.indirect += 1,
                Step::To(offset) => {
                    let target = (at + 4).wrapping_add_signed(offset);
                    // BL to its own begin: it calls itself.
                    let is_call = wide && second & 0xD000 == 0xD000;
                    if !span.contains(&target) || is_call && target == span.start {
                        self.calls.insert(places.partition_point(|&place| place <= target).saturating_sub(1));
                    }
                }
            }
            at += if wide { 4 } else { 2 };
        }
    }
}

/// The lowest `bits` of a number, taken for one with a sign.
const fn signed(number: u32, bits: u32) -> i64 {
    (number << (32 - bits)).cast_signed() as i64 >> (32 - bits)
}

/// An instruction of 16 bits. Offsets count from four bytes behind it.
const fn step_narrow(half: u16) -> Step {
    let imm = half as u32;
    match half {
        // B with a condition. The last two are UDF and SVC.
        0xD000..=0xDDFF => Step::To(signed((imm & 0xFF) << 1, 9)),
        0xE000..=0xE7FF => Step::To(signed((imm & 0x7FF) << 1, 12)),
        // BX of anything but the link register, BLX.
        0x4700..=0x47FF => {
            if half == 0x4770 {
                Step::On
            } else {
                Step::Indirect
            }
        }
        // MOV and ADD to the program counter.
        _ if half & 0xFF87 == 0x4687 || half & 0xFF87 == 0x4487 => Step::Indirect,
        // CBZ, CBNZ.
        _ if half & 0xF500 == 0xB100 => Step::To(((imm >> 9 & 1) << 6 | (imm >> 3 & 0x1F) << 1) as i64),
        _ => Step::On,
    }
}

/// An instruction of 32 bits.
pub(super) const fn step_wide(first: u16, second: u16) -> Step {
    let (a, b) = (first as u32, second as u32);
    let sign = a >> 10 & 1;
    if first >> 11 == 0b11110 && second & 0x8000 != 0 {
        // BL and B.W, 25 bits.
        if second & 0x1000 != 0 {
            let i1 = !(b >> 13 ^ sign) & 1;
            let i2 = !(b >> 11 ^ sign) & 1;
            let imm = sign << 24 | i1 << 23 | i2 << 22 | (a & 0x3FF) << 12 | (b & 0x7FF) << 1;
            return Step::To(signed(imm, 25));
        }
        // B.W with a condition, 21 bits. The conditions 14 and 15 are other instructions.
        if second & 0x5000 == 0 && first >> 6 & 0xF < 14 {
            let imm =
                sign << 20 | (b >> 11 & 1) << 19 | (b >> 13 & 1) << 18 | (a & 0x3F) << 12 | (b & 0x7FF) << 1;
            return Step::To(signed(imm, 21));
        }
    }
    // LDR to the program counter. A return pops it from the stack (SP with write-back), and a table branch stays inside.
    if first & 0xFF70 == 0xF850 && second >> 12 == 15 && !(first == 0xF85D && second & 0xFFF == 0xB04) {
        return Step::Indirect;
    }
    Step::On
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn branches_are_told_from_their_encodings() {
        // As an assembler writes them: `b .`, `beq .+8`, `cbz r0, .+8`, `bx lr`, `blx r1`, `mov pc, r1`, `udf #254`.
        for (half, step) in [
            (0xE7FE, Step::To(-4)),
            (0xD002, Step::To(4)),
            (0xB110, Step::To(4)),
            (0x4770, Step::On),
            (0x4788, Step::Indirect),
            (0x468F, Step::Indirect),
            (0xDEFE, Step::On),
            (0xDF00, Step::On),
            (0xBF00, Step::On),
        ] {
            assert_eq!(step_narrow(half), step, "{half:#x}");
        }
        // `bl .`, `b.w .`, `beq.w .`, `ldr pc, [r0]`, `pop.w {pc}` as a load, `udf.w #0`, `msr primask, r0`, `dmb`.
        for (halves, step) in [
            ((0xF7FF, 0xFFFE), Step::To(-4)),
            ((0xF7FF, 0xBFFE), Step::To(-4)),
            ((0xF43F, 0xAFFE), Step::To(-4)),
            ((0xF8D0, 0xF000), Step::Indirect),
            ((0xF85D, 0xFB04), Step::On),
            ((0xF7F0, 0xA000), Step::On),
            ((0xF380, 0x8810), Step::On),
            ((0xF3BF, 0x8F5F), Step::On),
        ] {
            assert_eq!(step_wide(halves.0, halves.1), step, "{halves:#x?}");
        }
    }

    fn graph(calls: &[&[usize]]) -> Calls {
        let function = |(place, calls): (usize, &&[usize])| Function {
            name: format!("f{place}"),
            calls: calls.iter().copied().collect(),
            ..Function::default()
        };
        Calls(calls.iter().enumerate().map(function).collect())
    }

    #[test]
    fn what_is_reached_has_its_way_and_what_is_not_has_none() {
        let calls = graph(&[&[1], &[2, 3], &[1], &[], &[3]]);
        let reached = calls.reached(&BTreeSet::from([0]));
        assert_eq!(reached.keys().copied().collect::<Vec<_>>(), [0, 1, 2, 3]);
        assert_eq!(calls.way(&reached, 3), "f0\n    -> f1\n    -> f3");
        assert_eq!(calls.callers(&BTreeSet::from([3])), BTreeSet::from([0, 1, 2, 4]));
    }
}
