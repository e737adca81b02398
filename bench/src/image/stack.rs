//! How deep an image's stack may get, read from its instructions: no run needed, and none can be deeper.
//!
//! A function takes the sum of all that its instructions take, whichever way it goes. A caller of a pointer may call every
//! function of the kind in [`pointers`]. Each priority may interrupt the one below at its deepest instant.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::{Context, Result, ensure};
use object::File;

use super::calls::Calls;
use super::pointers::calls_and_handlers;
use super::symbols::address_of;

/// An exception's frame with the FPU's registers, and what aligns it (ARMv7-M manual, B1.5.7).
const FRAME_BYTES: u64 = 104 + 4;
/// The guard of `firmware/src/stack.rs`, and the multiple that it begins at.
const GUARD_BYTES: u64 = 2048;
/// What each interrupt's priority is in the image; a reset sets all others to 0.
const PRIORITIES: [(&str, i8); 9] = [
    ("NonMaskableInt", -2),
    ("HardFault", -1),
    ("PVD", 0),
    ("DMA2_STREAM0", 1),
    ("TIM2", 1),
    ("I2C3_ER", 2),
    ("USART2", 6),
    ("DMA1_STREAM5", 6),
    ("DMA1_STREAM6", 6),
];
/// Parts of the names of functions that call each other in a circle, and how often a path may have all of them: the parts of a
/// message have parts, and the log of a panic may panic.
const CIRCLES: [(&str, u64); 5] =
    [("core3fmt", 3), ("core..fmt", 3), ("rust_begin_unwind", 2), ("panic_fmt", 2), ("defmt", 2)];

/// The most bytes that something takes, and by which way: a line for each function.
type Deepest = (u64, Vec<String>);

/// The deepest that an image's stack may get.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bound {
    pub bytes: u64,
    /// RAM that the stack may take: above the variables and the guard.
    pub free: u64,
    /// Of the main program (None) and of each priority.
    pub levels: BTreeMap<Option<i8>, Deepest>,
}

impl Bound {
    /// Reads an image's ELF file. Fails if what a function takes, or whom it calls, is not known.
    pub fn of(elf: &Path) -> Result<Self> {
        let bytes = std::fs::read(elf).with_context(|| format!("reading the image {}", elf.display()))?;
        let file = File::parse(&*bytes).context("not an ELF file")?;
        let guard = address_of(&file, "__sheap")?.next_multiple_of(GUARD_BYTES);
        let free = address_of(&file, "_stack_start")?.saturating_sub(guard + GUARD_BYTES);
        let (calls, handlers) = calls_and_handlers(&file)?;
        Self::from(&calls, &handlers, free).with_context(|| format!("the image {}", elf.display()))
    }

    fn from(calls: &Calls, handlers: &BTreeSet<usize>, free: u64) -> Result<Self> {
        let starts = calls.named(|name| name == "Reset");
        ensure!(!starts.is_empty(), "has no start");
        let (mut levels, mut known) = (BTreeMap::new(), BTreeMap::new());
        for &root in starts.iter().chain(handlers) {
            let (mut bytes, way) = depth(calls, root, &mut known)?;
            let level = (!starts.contains(&root)).then(|| {
                bytes += FRAME_BYTES;
                PRIORITIES.iter().find(|(name, _)| *name == calls.0[root].name).map_or(0, |(_, level)| *level)
            });
            let deepest: &mut Deepest = levels.entry(level).or_default();
            *deepest = std::mem::take(deepest).max((bytes, way));
        }
        Ok(Self { bytes: levels.values().map(|(bytes, _)| bytes).sum(), free, levels })
    }
}

/// What a function and all that it calls may take, and by which way.
fn depth(calls: &Calls, place: usize, known: &mut BTreeMap<usize, Deepest>) -> Result<Deepest> {
    if let Some(known) = known.get(&place) {
        return Ok(known.clone());
    }
    let called: BTreeSet<usize> = calls.reached(&calls.0[place].calls).into_keys().collect();
    let mut members: BTreeSet<usize> =
        calls.callers(&BTreeSet::from([place])).intersection(&called).copied().collect();
    let is_circle = !members.is_empty();
    members.insert(place);
    let mut own = 0;
    for function in members.iter().map(|&member| &calls.0[member]) {
        let name = &function.name;
        let times = CIRCLES.iter().find(|(part, _)| name.contains(part)).map(|(_, times)| *times);
        let times = if is_circle { times.with_context(|| format!("{name} may call itself"))? } else { 1 };
        own += times
            * function.stack.with_context(|| format!("{name} sets the stack's pointer to a register"))?;
    }
    let mut next = Deepest::default();
    for callee in members.iter().flat_map(|&member| &calls.0[member].calls) {
        if !members.contains(callee) {
            next = next.max(depth(calls, *callee, known)?);
        }
    }
    let circle = if is_circle { ", a circle" } else { "" };
    next.0 += own;
    next.1.insert(0, format!("{own:>6}  {}{circle}", calls.0[place].name));
    known.insert(place, next.clone());
    Ok(next)
}

/// Bytes that an instruction takes of the stack (ARMv7-M manual, A7.7). None if it sets the stack's pointer to what a register says.
pub(super) const fn taken(first: u16, second: u16) -> Option<u64> {
    let (ones, imm8) = (second.count_ones() as u64, second as u64 & 0xFF);
    Some(match first {
        // PUSH.
        0xB400..=0xB5FF => 4 * (first & 0x1FF).count_ones() as u64,
        // SUB to the pointer.
        0xB080..=0xB0FF => 4 * (first as u64 & 0x7F),
        // ADD and MOV of a register to it.
        _ if first & 0xFF87 == 0x4485 || first & 0xFF87 == 0x4685 => return None,
        // STMDB and LDMDB with write-back.
        0xE92D | 0xE93D => 4 * ones,
        // STRD and LDRD, VSTMDB and VLDMDB, with write-back of a lower address.
        _ if first & 0xFEEF == 0xE86D || first & 0xFEAF == 0xEC2D => 4 * imm8,
        // A load or a store, the same.
        _ if first & 0xFE8F == 0xF80D && second & 0x0B00 == 0x0900 => imm8,
        // SUB of an immediate, in both forms; ADD gives back.
        0xF1AD | 0xF5AD if second & 0x8F00 == 0x0D00 => expanded(first, second),
        0xF2AD | 0xF6AD if second & 0x8F00 == 0x0D00 => {
            (first as u64 >> 10 & 1) << 11 | (second as u64 >> 12 & 7) << 8 | imm8
        }
        0xF10D | 0xF50D | 0xF20D | 0xF60D => 0,
        // Whatever else computes or loads the pointer: MSR; the result in bits 8 to 11; a load's in 12 to 15.
        _ if first & 0xFFF0 == 0xF380 && second & 0xFFFE == 0x8808 => return None,
        _ if (first & 0xFE00 == 0xEA00 || first & 0xF800 == 0xF000 && second & 0x8000 == 0)
            && second & 0x0F00 == 0x0D00 =>
        {
            return None;
        }
        _ if first & 0xFF70 == 0xF850 && second >> 12 == 13 => return None,
        _ => 0,
    })
}

/// An immediate of 12 bits that stands for one of 32 (ThumbExpandImm, A5.3.2).
const fn expanded(first: u16, second: u16) -> u64 {
    let imm8 = second as u32 & 0xFF;
    let kind = (first as u32 >> 10 & 1) << 3 | second as u32 >> 12 & 7;
    let number = match kind {
        0 => imm8,
        1 => imm8 << 16 | imm8,
        2 => imm8 << 24 | imm8 << 8,
        3 => imm8 * 0x0101_0101,
        _ => (imm8 | 0x80).rotate_right(kind << 1 | imm8 >> 7),
    };
    number as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::calls::Function;

    #[test]
    fn what_is_taken_is_told_from_encodings() {
        let taken = |word: u32| {
            if word >> 16 == 0 { taken(word as u16, 0) } else { taken((word >> 16) as u16, word as u16) }
        };
        // As an assembler writes them: `push {r4, r5, lr}`, `sub sp, #24`, `stmdb sp!` of nine, `str [sp, #-4]!`, `strd [sp, #-16]!`,
        // `vpush {d8-d9}`, `vpush {s16}`, `sub.w` of 768, 14720 and 0xff00ff, `subw` of 2052 and 1028.
        let words = [
            0xB530, 0xB086, 0xE92D4FF0, 0xF84D8D04, 0xE96D4504, 0xED2D8B04, 0xED2D8A01, 0xF5AD7D40,
            0xF5AD5D66, 0xF1AD1DFF, 0xF6AD0D04, 0xF2AD4D04,
        ];
        let bytes = [12, 24, 36, 4, 16, 16, 4, 768, 14_720, 0xFF_00FF, 2052, 1028];
        assert_eq!(words.map(taken), bytes.map(Some));
        // `pop`, `add sp`, `cmp sp, r0`, `str [sp, #4]!`, `ldmia sp!`, `add.w`, `addw`, `vpop`, `str [sp, #2544]`, `ldrd [sp, #16]`,
        // `add.w r0, sp`, `stmdb r0!`, `msr primask`.
        let nothing = [
            0xBD10, 0xB006, 0x4585, 0xF84DBF04, 0xE8BD8FF0, 0xF50D7D40, 0xF60D0D04, 0xECBD8B04, 0xF8CD09F0,
            0xE9DD4504, 0xF50D7040, 0xE9200006, 0xF3808810,
        ];
        assert_eq!(nothing.map(taken), [Some(0); 13]);
        // `mov sp, r7`, `add sp, r3`, `sub.w sp, sp, r3`, `ldr sp, [r0]`, `msr msp`.
        assert_eq!([0x46BD, 0x449D, 0xEBAD0D03, 0xF8D0D000, 0xF3808808].map(taken), [None; 5]);
    }

    /// A start that calls two functions, of which one calls the third; and two handlers of a priority, one of another.
    fn image(third: Option<u64>, third_calls: &[usize]) -> Result<Bound> {
        let shape: [(&str, Option<u64>, &[usize]); 8] = [
            ("Reset", Some(8), &[1, 2]),
            ("f1", Some(100), &[]),
            ("f2", Some(10), &[3]),
            ("f3", third, third_calls),
            ("TIM2", Some(16), &[]),
            ("DMA2_STREAM0", Some(24), &[]),
            ("I2C3_ER", Some(32), &[1]),
            ("core3fmt", Some(5), &[7, 1]),
        ];
        let function = |(name, stack, calls): (&str, _, &[usize])| Function {
            name: name.to_owned(),
            stack,
            calls: calls.iter().copied().collect(),
            ..Function::default()
        };
        Bound::from(&Calls(shape.map(function).into()), &BTreeSet::from([4, 5, 6]), 1000)
    }

    #[test]
    fn the_deepest_path_of_each_priority_is_added_up() {
        let levels = |third, calls: &[usize]| {
            image(third, calls).unwrap().levels.into_values().map(|(bytes, _)| bytes).collect::<Vec<_>>()
        };
        assert_eq!(levels(Some(4), &[]), [108, 24 + 108, 132 + 108]);
        assert_eq!(levels(Some(91), &[]), [109, 24 + 108, 132 + 108]);
        assert_eq!(image(Some(91), &[]).unwrap().bytes, 109 + 132 + 240);
        let way = ["     8  Reset", "    10  f2", "    91  f3"].map(str::to_owned);
        assert_eq!(image(Some(91), &[]).unwrap().levels[&None], (109, way.to_vec()));
        // A circle that is named has all of it as often as it says; f1 comes behind it once.
        assert_eq!(levels(Some(4), &[7]), [8 + 10 + 4 + 3 * 5 + 100, 132, 240]);
    }

    #[test]
    fn what_cannot_be_read_is_an_error() {
        for (third, calls, says) in [
            (None, &[][..], "f3 sets the stack's pointer"),
            (Some(4), &[2], "f2 may call itself"),
            (Some(4), &[3], "f3 may call itself"),
        ] {
            let error = image(third, calls).unwrap_err().to_string();
            assert!(error.starts_with(says), "{error}");
        }
    }

    #[test]
    fn priorities_are_those_of_the_firmware() {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../firmware/src");
        let mut set = BTreeSet::new();
        for file in source.read_dir().unwrap().map(|file| file.unwrap().path()).filter(|file| file.is_file())
        {
            for line in std::fs::read_to_string(file).unwrap().lines() {
                let Some((before, after)) = line.split_once("set_priority(Priority::P") else { continue };
                let name = before.trim_end_matches(['.', ':']).rsplit(':').next().unwrap().to_owned();
                set.insert((name, after[..1].parse::<i8>().unwrap()));
            }
        }
        let own =
            PRIORITIES.iter().filter(|(_, level)| *level >= 0).map(|&(name, level)| (name.to_owned(), level));
        assert_eq!(set, own.collect());
    }
}
