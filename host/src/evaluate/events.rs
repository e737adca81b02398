//! Slips as events: whether each was caught, how soon, and what was called slip and was none (`docs/glossary.md`, event scores).
//!
//! A labelled recording does not say when micro slip began, so what speaks up to 50 ms before the first step of a slip is
//! taken as that slip's, and no earlier.

use tenax_hal_shim::channel::SLOW_HZ;

use crate::labelled::Step;

/// 50 ms: two slips that are nearer than this are one, and a detection may be so early or so late.
const NEAR: usize = SLOW_HZ as usize / 20;
/// A step, ms.
const STEP_MS: f64 = 1e3 / SLOW_HZ as f64;

/// What became of the slips of recordings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Events {
    /// Slips.
    pub count: usize,
    /// Latency of each that was caught, ms: of the first step that was called slip after the slip's first step.
    pub latencies_ms: Vec<f64>,
    /// Detections that belong to no slip.
    pub false_alarms: usize,
}

impl Events {
    /// Adds those of one recording.
    pub fn take(&mut self, steps: &[Step], verdicts: &[bool]) {
        let slips = slips(steps);
        let rises: Vec<usize> = rises(verdicts);
        self.count += slips.len();
        for &(first, _) in &slips {
            let early = first.saturating_sub(NEAR);
            // A verdict that rose long before is no detection of this slip, but its standing so is.
            let rose = rises.iter().copied().find(|rise| (early..=first + NEAR).contains(rise));
            let stands = verdicts.get(first).is_some_and(|&slip| slip).then_some(first);
            if let Some(at) = rose.or(stands) {
                self.latencies_ms.push((at as f64 - first as f64) * STEP_MS);
            }
        }
        let belongs = |rise: &usize| {
            slips.iter().any(|&(first, last)| (first.saturating_sub(NEAR)..=last + NEAR).contains(rise))
        };
        self.false_alarms += rises.iter().filter(|rise| !belongs(rise)).count();
    }

    /// The latency that this part of those caught do not exceed, ms. None if none was caught.
    #[must_use]
    pub fn latency_ms(&self, part: f64) -> Option<f64> {
        let mut sorted = self.latencies_ms.clone();
        sorted.sort_by(f64::total_cmp);
        let rank = (part * sorted.len() as f64).ceil() as usize;
        sorted.get(rank.max(1) - 1).copied()
    }
}

/// First and last step of each slip.
#[must_use]
pub fn slips(steps: &[Step]) -> Vec<(usize, usize)> {
    let mut slips: Vec<(usize, usize)> = Vec::new();
    for (at, _) in steps.iter().enumerate().filter(|(_, step)| step.slip) {
        match slips.last_mut() {
            Some((_, last)) if at - *last <= NEAR => *last = at,
            _ => slips.push((at, at)),
        }
    }
    slips
}

fn rises(verdicts: &[bool]) -> Vec<usize> {
    (0..verdicts.len()).filter(|&at| verdicts[at] && (at == 0 || !verdicts[at - 1])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(slips: &[std::ops::RangeInclusive<usize>]) -> Vec<Step> {
        let slip = |at: usize| slips.iter().any(|slip| slip.contains(&at));
        (0..100).map(|at| Step { samples: [0; 10], slip: slip(at) }).collect()
    }

    fn verdicts(spans: &[std::ops::RangeInclusive<usize>]) -> Vec<bool> {
        steps(spans).iter().map(|step| step.slip).collect()
    }

    #[test]
    fn slips_within_50_ms_of_each_other_are_one() {
        assert_eq!(slips(&steps(&[10..=12, 16..=20, 25..=30])), [(10, 20), (25, 30)]);
    }

    #[test]
    fn caught_is_from_50_ms_before_to_50_ms_after() {
        for (said, caught_ms, false_alarms) in [
            (6..=9, Some(-50.0), 0),
            (10..=12, Some(0.0), 0),
            (14..=14, Some(50.0), 0),
            // Too late to catch it, but it is this slip all the same.
            (15..=16, None, 0),
            (24..=24, None, 0),
            (25..=25, None, 1),
            (5..=9, None, 1),
            (2..=30, Some(0.0), 1),
        ] {
            let mut events = Events::default();
            events.take(&steps(&[10..=20]), &verdicts(std::slice::from_ref(&said)));
            assert_eq!((events.latency_ms(0.5), events.false_alarms), (caught_ms, false_alarms), "{said:?}");
            assert_eq!(events.count, 1);
        }
    }

    #[test]
    fn quantiles_are_of_those_caught() {
        let events = Events { count: 9, latencies_ms: vec![30.0, 10.0, 20.0], false_alarms: 0 };
        assert_eq!((events.latency_ms(0.5), events.latency_ms(0.95)), (Some(20.0), Some(30.0)));
        assert_eq!(Events::default().latency_ms(0.5), None);
    }
}
