//! The camera as a teacher (Tada 2006, equations 1 and 2). There is a lesson only while the finger holds
//! something undisturbed, and fresh codes agree that something moves. Codes chatter (section III.B), so each is
//! the median of the last three messages.

use tenax_hal_shim::words::{Code, Codes, NoLesson};

use crate::latest;

const MEMORY: usize = 3;

#[derive(Clone, Debug, Default)]
pub struct Teacher {
    said: [Codes; MEMORY],
    heard: usize,
    age_ms: u16,
}

impl Teacher {
    /// Codes of an older picture than the newest are dropped; a silence of `fresh_ms` forgets those before it.
    pub fn receive(&mut self, fresh_ms: u16, codes: Codes, age_ms: u16) {
        if self.age_ms > fresh_ms {
            self.heard = 0;
        }
        if self.heard > 0 && age_ms > self.age_ms {
            return;
        }
        latest::push(&mut self.said, codes);
        self.heard = (self.heard + 1).min(MEMORY);
        self.age_ms = age_ms;
    }

    pub fn tick_ms(&mut self) {
        self.age_ms = self.age_ms.saturating_add(1);
    }

    pub fn age_ms(&self) -> Option<u16> {
        (self.heard > 0).then_some(self.age_ms)
    }

    /// `fresh_ms`: age of the picture beyond which its codes are not used. `disturbed`: the motor runs, the hand
    /// is struck or swung, or a receptor has just been lost.
    pub fn lesson(&self, fresh_ms: u16, grasp: bool, disturbed: bool) -> Result<Codes, NoLesson> {
        if self.heard == 0 {
            return Err(NoLesson::Absent);
        }
        if self.age_ms > fresh_ms {
            return Err(NoLesson::Late);
        }
        if self.heard < MEMORY {
            return Err(NoLesson::Absent);
        }
        let codes = [self.median(0)?, self.median(1)?];
        match codes {
            [Code::Zero, Code::Zero] => Err(NoLesson::NothingMoves),
            // "Both the hand and the object do not move", and the hand moves.
            [Code::Zero, _] => Err(NoLesson::Contradicting),
            _ if !grasp => Err(NoLesson::NoGrasp),
            _ if disturbed => Err(NoLesson::Disturbed),
            _ => Ok(codes),
        }
    }

    fn median(&self, output: usize) -> Result<Code, NoLesson> {
        let signs = self.said.map(|codes| codes[output].sign());
        if signs.contains(&1) && signs.contains(&-1) {
            return Err(NoLesson::Contradicting);
        }
        // Without opposites the sum is the number of codes that are not zero, with their sign.
        let sum: i32 = signs.iter().sum();
        Ok(Code::from_sign(sum / 2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Code::{Minus, Plus, Zero};

    const FRESH_MS: u16 = 120;

    fn after(messages: &[Codes]) -> Teacher {
        let mut teacher = Teacher::default();
        for &codes in messages {
            teacher.receive(FRESH_MS, codes, 40);
            for _ in 0..33 {
                teacher.tick_ms();
            }
        }
        teacher
    }

    fn lesson(messages: &[Codes]) -> Result<Codes, NoLesson> {
        after(messages).lesson(FRESH_MS, true, false)
    }

    #[test]
    fn a_teacher_has_to_say_it_three_times_and_may_stumble_once() {
        const SLIPS: Codes = [Minus, Plus];
        const STILL: Codes = [Zero, Zero];
        assert_eq!(lesson(&[]), Err(NoLesson::Absent));
        assert_eq!(lesson(&[SLIPS; 2]), Err(NoLesson::Absent));
        assert_eq!(lesson(&[SLIPS; 3]), Ok(SLIPS));
        for stumble in 0..3 {
            let mut messages = [SLIPS; 3];
            messages[stumble] = STILL;
            assert_eq!(lesson(&messages), Ok(SLIPS));
            let mut messages = [STILL; 3];
            messages[stumble] = SLIPS;
            assert_eq!(lesson(&messages), Err(NoLesson::NothingMoves));
        }
    }

    #[test]
    fn opposite_codes_teach_nothing_until_they_are_forgotten() {
        let (slips, holds) = ([Minus, Plus], [Plus, Plus]);
        assert_eq!(lesson(&[slips, slips, holds]), Err(NoLesson::Contradicting));
        assert_eq!(lesson(&[slips, holds, holds]), Err(NoLesson::Contradicting));
        assert_eq!(lesson(&[slips, holds, holds, holds]), Ok(holds));
        for n in 3..40 {
            let alternating: std::vec::Vec<_> = (0..n).map(|n| [slips, holds][n % 2]).collect();
            assert_eq!(lesson(&alternating), Err(NoLesson::Contradicting));
        }
        assert_eq!(lesson(&[[Zero, Plus]; 3]), Err(NoLesson::Contradicting));
    }

    #[test]
    fn a_late_teacher_teaches_nothing_and_has_to_be_believed_anew() {
        let mut teacher = after(&[[Minus, Plus]; 3]);
        for _ in 73..120 {
            teacher.tick_ms();
        }
        assert!(teacher.lesson(FRESH_MS, true, false).is_ok());
        teacher.tick_ms();
        assert_eq!(teacher.lesson(FRESH_MS, true, false), Err(NoLesson::Late));
        for _ in 0..100_000 {
            teacher.tick_ms();
        }
        assert_eq!(teacher.lesson(FRESH_MS, true, false), Err(NoLesson::Late));
        teacher.receive(FRESH_MS, [Minus, Plus], 40);
        assert_eq!(teacher.lesson(FRESH_MS, true, false), Err(NoLesson::Absent));
        let mut late = Teacher::default();
        for _ in 0..9 {
            late.receive(FRESH_MS, [Minus, Plus], 121);
        }
        assert_eq!(late.lesson(FRESH_MS, true, false), Err(NoLesson::Late));
    }
}
