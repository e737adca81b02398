//! Slips of a recording and what a detector said of them, scored by [`crate::scorer`].

use tenax_hal_shim::channel::{FRAME_HZ, SLOW_HZ};
use tenax_hal_shim::schedule::{Job, slot_of};

use super::Verdicts;
use crate::labelled::Recording;
use crate::scorer::{Card, Stretch, Verdict};

const STEP_S: f64 = 1.0 / SLOW_HZ as f64;

fn decided_after_s() -> f64 {
    // The array begins in the slot behind the last reading.
    f64::from(slot_of(Job::MlpDecides) + 1 - slot_of(Job::ArrayBegins)) / f64::from(FRAME_HZ)
}

/// The stretches in which slip was said of a recording that begins at `first_s`.
pub fn stretches(first_s: f64, said: &[bool]) -> Vec<Verdict> {
    let at_s = |step: usize| first_s + step as f64 * STEP_S + decided_after_s();
    let mut all: Vec<Verdict> = Vec::new();
    said.iter().enumerate().for_each(|(step, &now)| Verdict::go_on(&mut all, at_s(step), now));
    all
}

pub fn card(recording: &Recording, said: &Verdicts) -> Card {
    let from_s = recording.first_s;
    let whole =
        Stretch { from_s, to_s: from_s + recording.steps.len() as f64 * STEP_S, doing: recording.doing };
    Card::of(&recording.slips, &stretches(from_s, said), &[whole])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_begins_where_its_tick_decides() {
        // The tenth element is read in slot 9 and the verdict falls in slot 14: 2.5 ms later.
        let said = [false, true, true, false, true];
        let found = stretches(0.005, &said);
        assert!((found[0].from_s - 0.020).abs() < 1e-12 && (found[0].to_s - 0.045).abs() < 1e-12);
        assert_eq!((found.len(), found[1].to_s), (2, f64::INFINITY));
    }
}
