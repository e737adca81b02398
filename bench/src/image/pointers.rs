//! Whom a call through a pointer may reach, by who calls.
//!
//! Every function whose address the image holds is of one of three kinds: a task's poll, what a waker does, or a part of how a
//! message is written. Any other is an error, and so is a call through a pointer from where none of these is expected.

use std::collections::BTreeSet;

use anyhow::{Context, Result, ensure};
use object::{File, Object, ObjectSection};

use super::calls::{Calls, Function};
use super::symbols::TICK;

/// Where a Cortex-M finds its exceptions.
const VECTORS: &str = ".vector_table";
/// An image of ours has so many handlers at least: of faults, of the frame, the line, the bus, the supply.
const HANDLERS_MIN: usize = 10;
/// Parts of the names of tasks.
const POLLS: [&str; 2] = ["TaskStorage", "poll_exited"];
/// What an interrupt calls through a task's waker, and a task when it registers one.
const WAKERS: [&str; 1] = ["embassy_executor3raw5waker"];
/// A message's parts: `core::fmt` of either mangling, and defmt's writer.
const MESSAGES: [&str; 3] = ["4core3fmt", "core..fmt", "FmtWrite"];
/// The executors, whose pointers are polls: control's interrupt and the main program's.
const URGENT: [&str; 1] = ["I2C3_ER"];
const MAIN: [&str; 1] = ["thread8Executor3run"];
/// Whose pointers are wakers.
const WAKING: [&str; 6] = ["DMA1_STREAM", "DMA2_STREAM0", "TIM2", "USART2", "tenax_firmware", "TaskStorage"];

/// Who calls whom, pointers included, and the handlers of interrupts and faults. Fails on a pointer that nobody knows.
pub fn calls_and_handlers(file: &File<'_>) -> Result<(Calls, BTreeSet<usize>)> {
    let mut calls = Calls::of(file)?;
    let places = |addresses: &BTreeSet<u64>| {
        let is_there = |(_, own): &(usize, &Function)| {
            own.instructions.first().is_some_and(|first| addresses.contains(&(first | 1)))
        };
        calls.0.iter().enumerate().filter(is_there).map(|(place, _)| place).collect::<BTreeSet<_>>()
    };
    // After the stack and the start, which are no interrupts.
    let handlers = places(&words(file, VECTORS)?.skip(2).collect());
    ensure!(
        handlers.len() >= HANDLERS_MIN,
        "has {} handlers of interrupts: some were not found",
        handlers.len()
    );
    let held = places(&addresses(&calls, file)?);
    resolve(&mut calls, &held)?;
    Ok((calls, handlers))
}

/// A section, as words.
fn words<'a>(file: &File<'a>, section: &str) -> Result<impl Iterator<Item = u64> + use<'a>> {
    let data = file.section_by_name(section).with_context(|| format!("has no {section} section"))?.data()?;
    Ok(data.chunks_exact(4).map(|word| u64::from(u32::from_le_bytes([word[0], word[1], word[2], word[3]]))))
}

/// Every word and every number of 32 bits that an instruction pair makes (MOVW, MOVT).
fn addresses(calls: &Calls, file: &File<'_>) -> Result<BTreeSet<u64>> {
    let mut all = BTreeSet::new();
    for section in [".text", ".rodata", ".data"] {
        all.extend(words(file, section)?);
    }
    let text = file.section_by_name(".text").context("has no .text section")?;
    let (base, code) = (text.address(), text.data()?);
    for function in &calls.0 {
        let mut low = [0; 16];
        for &at in &function.instructions {
            let Some(&[a, b, c, d]) = code.get((at - base) as usize..).and_then(|code| code.first_chunk())
            else {
                continue;
            };
            let (first, second) =
                (u64::from(u16::from_le_bytes([a, b])), u64::from(u16::from_le_bytes([c, d])));
            let imm16 =
                (first & 15) << 12 | (first >> 10 & 1) << 11 | (second >> 12 & 7) << 8 | second & 0xFF;
            let register = (second >> 8 & 15) as usize;
            match first & 0xFBF0 {
                0xF240 => low[register] = imm16,
                0xF2C0 => _ = all.insert(imm16 << 16 | low[register]),
                _ => {}
            }
        }
    }
    Ok(all)
}

/// Adds to each function that calls through a pointer every one that it may reach, of those whose address the image holds.
fn resolve(calls: &mut Calls, held: &BTreeSet<usize>) -> Result<()> {
    let named = |parts: &[&str]| calls.named(|name| parts.iter().any(|part| name.contains(part)));
    let held_of = |parts: &[&str]| named(parts).intersection(held).copied().collect::<BTreeSet<_>>();
    let (polls, wakers, messages) = (held_of(&POLLS), held_of(&WAKERS), held_of(&MESSAGES));
    for place in held {
        let is_known = [&polls, &wakers, &messages].iter().any(|kind| kind.contains(place));
        ensure!(is_known, "nobody knows who calls {} through a pointer", calls.0[*place].name);
    }
    // An interrupt's executor has the task of the tick, the main program's has the others.
    let of_tick = calls.callers(&named(&[TICK]));
    let (urgent, others): (BTreeSet<_>, _) = polls.iter().partition(|place| of_tick.contains(place));
    let kinds = [
        (named(&URGENT), &urgent),
        (named(&MAIN), &others),
        (named(&MESSAGES), &messages),
        (named(&WAKING), &wakers),
    ];
    for (place, own) in calls.0.iter_mut().enumerate().filter(|(_, own)| own.indirect > 0) {
        let kind = kinds.iter().find(|(callers, _)| callers.contains(&place));
        let (_, reached) =
            kind.with_context(|| format!("nobody knows what {} calls through a pointer", own.name))?;
        own.calls.extend(reached.iter());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Which function calls which, once pointers are known; or why not.
    fn resolved(more: &str) -> Result<Vec<Vec<usize>>> {
        let names = [
            TICK,
            "I2C3_ER",
            "_ZN16embassy_executor8platform6thread8Executor3run",
            "_ZN16embassy_executor3raw20TaskStorage$LT$F$GT$4poll17h1",
            "_ZN16embassy_executor3raw20TaskStorage$LT$F$GT$4poll17h2",
            "_ZN16embassy_executor3raw5waker4wake",
            "_RNvNtCs7ldSeZOOJos_4core3fmt5write",
            more,
        ];
        let function = |name: &str| Function { name: name.to_owned(), indirect: 1, ..Function::default() };
        let mut calls = Calls(names.map(function).into());
        for place in [0, 5] {
            calls.0[place].indirect = 0;
        }
        calls.0[3].calls.insert(0);
        resolve(&mut calls, &BTreeSet::from([3, 4, 5, 6]))?;
        Ok(calls.0.into_iter().map(|own| own.calls.into_iter().collect()).collect())
    }

    #[test]
    fn each_caller_of_a_pointer_reaches_its_kind() {
        let expected: [&[usize]; 8] = [&[], &[3], &[4], &[0, 5], &[5], &[], &[6], &[5]];
        assert_eq!(resolved("TIM2").unwrap(), expected);
    }

    #[test]
    fn an_unknown_caller_or_function_is_an_error() {
        let error = resolved("tenax_logic").unwrap_err().to_string();
        assert_eq!(error, "nobody knows what tenax_logic calls through a pointer");
        let mut calls = Calls(vec![Function { name: "tenax_logic".to_owned(), ..Function::default() }]);
        let error = resolve(&mut calls, &BTreeSet::from([0])).unwrap_err().to_string();
        assert_eq!(error, "nobody knows who calls tenax_logic through a pointer");
    }
}
