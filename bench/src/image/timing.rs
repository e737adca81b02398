//! How many cycles a Cortex-M4 takes for what it executed: an estimate from each instruction's class.
//!
//! Timings are those of the processor's manual (ARM 100166, Cortex-M4 TRM, 3.3); the flash is the STM32F411's at 100 MHz: three wait
//! states, lines of 16 bytes, 64 lines of instructions and 8 of literals kept, the next line fetched ahead (RM0383, 3.4). Assumed: a
//! taken branch refills the pipeline in one cycle (two if its target is a wide instruction that is not aligned, or in a register); a
//! division takes six; nothing is in the caches when a kernel is entered.

/// What an instruction is to the pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// So many cycles, whatever comes before and after.
    Plain(u64),
    /// A load of one register.
    Load,
    /// A store of one register to a constant offset, which the write buffer takes.
    Store,
    /// A store to an offset in a register.
    StoreAt,
    /// A transfer of so many registers; the last may be the program counter.
    Many(u64, bool),
    /// A branch whose target is in the instruction.
    Branch,
    /// One whose target is in a register.
    Indirect,
    /// A load of the program counter, a branch by a table.
    LoadsTarget,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    pub class: Class,
    /// Whether it has 32 bits.
    pub wide: bool,
    /// Registers that it computes, a bit each.
    pub computes: u16,
    /// Registers that its address is made of.
    pub address: u16,
    /// A literal's distance from the instruction's address, rounded down to a word.
    pub literal: Option<i64>,
}

impl Instruction {
    /// By its first half, and its second one if it is wide.
    pub fn of(first: u16, second: u16) -> Self {
        if first >> 11 >= 0b11101 { wide(first, second) } else { narrow(first) }
    }

    const fn plain(cycles: u64, wide: bool, computes: u16) -> Self {
        Self { class: Class::Plain(cycles), wide, computes, address: 0, literal: None }
    }

    const fn of_class(class: Class, wide: bool) -> Self {
        Self { class, wide, computes: 0, address: 0, literal: None }
    }

    const fn memory(class: Class, wide: bool, address: u16) -> Self {
        Self { class, wide, computes: 0, address, literal: None }
    }

    pub const fn bytes(&self) -> u64 {
        if self.wide { 4 } else { 2 }
    }
}

const fn bit(register: u16) -> u16 {
    1 << (register & 15)
}

fn narrow(half: u16) -> Instruction {
    use Class::{Branch, Indirect, Load, Many, Store, StoreAt};
    let low = bit(half & 7);
    let base = bit(half >> 3 & 7);
    match half {
        0x2000..=0x3FFF => Instruction::plain(1, false, bit(half >> 8 & 7)),
        0x0000..=0x43FF => Instruction::plain(1, false, low),
        0x4400..=0x46FF => match (half & 7) | (half >> 4 & 8) {
            15 => Instruction::of_class(Indirect, false),
            register => Instruction::plain(1, false, bit(register)),
        },
        0x4700..=0x47FF => Instruction::of_class(Indirect, false),
        0x4800..=0x4FFF => Instruction {
            literal: Some(i64::from(half & 0xFF) * 4 + 4),
            ..Instruction::memory(Load, false, 0)
        },
        0x5000..=0x5FFF => {
            let class = if half >> 9 & 7 >= 3 { Load } else { StoreAt };
            Instruction::memory(class, false, base | bit(half >> 6 & 7))
        }
        0x6000..=0x8FFF => Instruction::memory(if half & 0x0800 != 0 { Load } else { Store }, false, base),
        0x9000..=0x9FFF => Instruction::memory(if half & 0x0800 != 0 { Load } else { Store }, false, bit(13)),
        0xA000..=0xAFFF => Instruction::plain(1, false, bit(half >> 8 & 7)),
        _ if half & 0xF500 == 0xB100 => Instruction::of_class(Branch, false),
        0xB400..=0xB5FF | 0xBC00..=0xBDFF => {
            let pops = half & 0x0800 != 0;
            Instruction::of_class(
                Many(u64::from((half & 0x1FF).count_ones()), pops && half & 0x100 != 0),
                false,
            )
        }
        0xC000..=0xCFFF => Instruction::memory(Many(u64::from((half & 0xFF).count_ones()), false), false, 0),
        0xD000..=0xDDFF | 0xE000..=0xE7FF => Instruction::of_class(Branch, false),
        _ => Instruction::plain(1, false, if half >> 8 == 0xB2 { low } else { 0 }),
    }
}

fn wide(first: u16, second: u16) -> Instruction {
    use Class::{Branch, Load, LoadsTarget, Many, Store, StoreAt};
    let (n, t, d) = (first & 15, second >> 12, second >> 8 & 15);
    let loads = first & 0x10 != 0;
    match first >> 8 {
        // LDRD, STRD, exclusive; a branch by a table.
        0xE8 | 0xE9 if first & 0x40 != 0 => {
            if first & 0xFFF0 == 0xE8D0 && second & 0xFFE0 == 0xF000 {
                Instruction::of_class(LoadsTarget, true)
            } else {
                Instruction::memory(Many(2, false), true, bit(n))
            }
        }
        0xE8 | 0xE9 => {
            let many = Many(u64::from(second.count_ones()), loads && second & 0x8000 != 0);
            Instruction::memory(many, true, 0)
        }
        0xEC..=0xEE => floats(first, second, loads),
        0xEA | 0xEB => Instruction::plain(1, true, bit(d)),
        0xF0..=0xF7 if second & 0x8000 == 0 => Instruction::plain(1, true, bit(d)),
        0xF0..=0xF7 => {
            let is_branch = second & 0x1000 != 0 || first >> 6 & 0xF < 14;
            if is_branch { Instruction::of_class(Branch, true) } else { Instruction::plain(2, true, 0) }
        }
        0xF8 | 0xF9 => {
            let constant = first & 0x80 != 0 || second & 0x0800 != 0 || n == 15;
            let address = bit(n) | if constant { 0 } else { bit(second) };
            match (loads, constant) {
                (true, _) if t == 15 && first & 0x60 == 0x40 => Instruction::of_class(LoadsTarget, true),
                (true, _) if n == 15 => {
                    let far = i64::from(second & 0xFFF);
                    let literal = 4 + if first & 0x80 != 0 { far } else { -far };
                    Instruction { literal: Some(literal), ..Instruction::memory(Load, true, 0) }
                }
                (true, _) => Instruction::memory(Load, true, address),
                (false, true) => Instruction::memory(Store, true, address),
                (false, false) => Instruction::memory(StoreAt, true, address),
            }
        }
        0xFB => multiplies(first, second, bit(d), t),
        _ => Instruction::plain(1, true, bit(d)),
    }
}

/// Products and quotients: MLA and MLS take two cycles.
const fn multiplies(first: u16, second: u16, d: u16, t: u16) -> Instruction {
    match first >> 4 & 0xF {
        0x0 => Instruction::plain(if t == 15 && second & 0xF0 == 0 { 1 } else { 2 }, true, d),
        0x9 | 0xB if second & 0xF0 == 0xF0 => Instruction::plain(6, true, d),
        0x8..=0xF => Instruction::plain(1, true, d | bit(t)),
        _ => Instruction::plain(1, true, d),
    }
}

/// The floating-point unit's: single precision.
fn floats(first: u16, second: u16, loads: bool) -> Instruction {
    if first >> 8 == 0xEE {
        if second & 0x10 != 0 {
            return Instruction::plain(1, true, 0);
        }
        let cycles = match (first >> 4 & 0xB, first & 0xF, second >> 6 & 3) {
            (0x0 | 0x1 | 0x9 | 0xA, ..) => 3,
            (0x8, ..) | (0xB, 1, 3) => 14,
            _ => 1,
        };
        return Instruction::plain(cycles, true, 0);
    }
    match first {
        _ if first & 0xFF20 == 0xED00 => {
            let class = if loads { Class::Load } else { Class::Store };
            Instruction::memory(class, true, bit(first & 15))
        }
        _ if first & 0xFFE0 == 0xEC40 => Instruction::plain(2, true, 0),
        _ => Instruction::of_class(Class::Many(u64::from(second & 0xFF), false), true),
    }
}

/// A flash and its caches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flash {
    /// Bytes that it gives at once.
    pub line: u64,
    /// Lines of instructions, and of literals, that are kept.
    pub kept: [usize; 2],
    /// Cycles that it takes longer than the core.
    pub waits: u64,
    /// Whether the next line is fetched ahead.
    pub ahead: bool,
}

impl Flash {
    /// The STM32F411's at 100 MHz.
    pub const F411: Self = Self { line: 16, kept: [64, 8], waits: 3, ahead: true };
}

/// How much an estimate leaves open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cycles {
    /// Every fetch is served at once and every branch taken refills in one cycle.
    pub least: u64,
    pub likely: u64,
    /// Every branch taken refills in three, nothing is fetched ahead.
    pub most: u64,
}

impl Cycles {
    fn add(&mut self, [least, likely, most]: [u64; 3]) {
        self.least += least;
        self.likely += likely;
        self.most += most;
    }
}

/// Adds up what a core executes, instruction by instruction.
#[derive(Clone, Debug)]
pub struct Core {
    /// Newest last.
    lines: [Vec<u64>; 2],
    line: u64,
    /// Cycles since the line was entered.
    since: u64,
    before: Option<Instruction>,
    pub cycles: Cycles,
    flash: Flash,
}

impl Core {
    pub fn cold(flash: Flash) -> Self {
        let lines = [Vec::new(), Vec::new()];
        Self { lines, line: u64::MAX, since: 0, before: None, cycles: Cycles::default(), flash }
    }

    /// It executes `own` at an address and goes on at `next`.
    pub fn execute(&mut self, at: u64, own: Instruction, next: (u64, Option<Instruction>)) {
        let Flash { line: bytes, waits, ahead, .. } = self.flash;
        let line = at / bytes;
        if line != self.line {
            let hit = self.keeps(0, line);
            let follows = ahead && line == self.line.wrapping_add(1);
            let stall = match (hit, follows) {
                (true, _) => 0,
                (false, true) => (waits + 1).saturating_sub(self.since).min(waits),
                (false, false) => waits,
            };
            self.cycles.add([0, stall, if hit { 0 } else { waits }]);
            (self.line, self.since) = (line, 0);
        }
        if let Some(far) = own.literal
            && !self.keeps(1, (at & !3).wrapping_add_signed(far) / bytes)
        {
            self.cycles.add([0, waits, waits]);
        }
        let taken = next.0 != at + own.bytes();
        let spent = self.spent(own, taken, next);
        self.since += spent[1];
        self.cycles.add(spent);
        self.before = Some(own);
    }

    fn spent(&self, own: Instruction, taken: bool, (next, target): (u64, Option<Instruction>)) -> [u64; 3] {
        let refill = |indirect: bool| {
            let unaligned = target.is_some_and(|target| target.wide && !next.is_multiple_of(4));
            [1, if unaligned || indirect { 2 } else { 1 }, 3]
        };
        let flat = |cycles: u64| [cycles; 3];
        let plus = |cycles: u64, more: [u64; 3]| more.map(|more| cycles + more);
        let before = self.before.map(|before| before.class);
        let follows = matches!(before, Some(Class::Load | Class::Store | Class::StoreAt));
        // What was computed just now is not yet there to address with.
        let late = self.before.is_some_and(|before| before.computes & own.address != 0);
        let memory = match own.class {
            Class::Plain(cycles) => flat(cycles),
            Class::Load => flat(if follows { 1 } else { 2 }),
            Class::Store => flat(1),
            Class::StoreAt => flat(if before == Some(Class::Load) { 1 } else { 2 }),
            Class::Many(count, false) => flat(1 + count),
            Class::Many(count, true) => plus(1 + count, refill(true)),
            Class::Branch if !taken => flat(1),
            Class::Branch => plus(1, refill(false)),
            Class::Indirect => plus(1, refill(true)),
            Class::LoadsTarget => plus(2, refill(true)),
        };
        if late { plus(0, [memory[0], memory[1] + 1, memory[2] + 1]) } else { memory }
    }

    /// Whether a line is kept; it is from now on.
    fn keeps(&mut self, which: usize, line: u64) -> bool {
        let lines = &mut self.lines[which];
        let at = lines.iter().position(|&kept| kept == line);
        if let Some(at) = at {
            lines.remove(at);
        } else if lines.len() >= self.flash.kept[which] {
            lines.remove(0);
        }
        lines.push(line);
        at.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As an assembler writes them.
    #[test]
    fn classes_are_told_from_their_encodings() {
        use Class::{Branch, Indirect, Load, LoadsTarget, Many, Plain, Store, StoreAt};
        for (halves, class) in [
            ((0x1840, 0), Plain(1)),            // adds r0, r0, r1
            ((0x6808, 0), Load),                // ldr r0, [r1]
            ((0x6008, 0), Store),               // str r0, [r1]
            ((0x5088, 0), StoreAt),             // str r0, [r1, r2]
            ((0x4801, 0), Load),                // ldr r0, [pc, #4]
            ((0xB5F0, 0), Many(5, false)),      // push {r4-r7, lr}
            ((0xBDF0, 0), Many(5, true)),       // pop {r4-r7, pc}
            ((0x4770, 0), Indirect),            // bx lr
            ((0xD1FE, 0), Branch),              // bne .
            ((0xB110, 0), Branch),              // cbz r0, .+8
            ((0xF7FF, 0xFFFE), Branch),         // bl .
            ((0xFB01, 0x0002), Plain(2)),       // mla r0, r1, r2, r0
            ((0xFB01, 0xF002), Plain(1)),       // mul r0, r1, r2
            ((0xFBE2, 0x0164), Plain(1)),       // umaal r0, r1, r2, r4
            ((0xFBB1, 0xF0F2), Plain(6)),       // udiv r0, r1, r2
            ((0xE9D1, 0x2300), Many(2, false)), // ldrd r2, r3, [r1]
            ((0xE8B1, 0x003C), Many(4, false)), // ldm r1!, {r2-r5}
            ((0xE8DF, 0xF001), LoadsTarget),    // tbb [pc, r1]
            ((0xF8D1, 0x0004), Load),           // ldr.w r0, [r1, #4]
            ((0xF841, 0x0022), StoreAt),        // str.w r0, [r1, r2, lsl #2]
            ((0xEE70, 0x0A20), Plain(1)),       // vadd.f32
            ((0xEE80, 0x0A01), Plain(14)),      // vdiv.f32
            ((0xED91, 0x0A00), Load),           // vldr s0, [r1]
        ] {
            assert_eq!(Instruction::of(halves.0, halves.1).class, class, "{halves:#x?}");
        }
    }

    /// A loop of `subs; bne`, so many times round, as the manual times it: three cycles a turn, one less for the last.
    #[test]
    fn a_loop_costs_what_the_manual_says_and_the_flash_once() {
        let (subs, bne) = (Instruction::of(0x3801, 0), Instruction::of(0xD1FD, 0));
        let mut core = Core::cold(Flash::F411);
        for turn in (0..10).rev() {
            core.execute(0x100, subs, (0x102, Some(bne)));
            core.execute(0x102, bne, (if turn == 0 { 0x104 } else { 0x100 }, Some(subs)));
        }
        assert_eq!(core.cycles, Cycles { least: 29, likely: 29 + 3, most: 29 + 9 * 2 + 3 });
    }

    #[test]
    fn loads_that_follow_each_other_overlap_and_a_fresh_address_waits() {
        let (load, add) = (Instruction::of(0x6808, 0), Instruction::of(0x1849, 0));
        let run = |all: &[Instruction]| {
            let mut core = Core::cold(Flash { waits: 0, ..Flash::F411 });
            for (n, own) in all.iter().enumerate() {
                core.execute(2 * n as u64, *own, (2 * n as u64 + 2, None));
            }
            core.cycles.likely
        };
        assert_eq!(run(&[load, load, load]), 4);
        assert_eq!(run(&[load, add, load]), 2 + 1 + 3);
    }
}
