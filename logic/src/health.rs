//! Sensor quality: a reading is a value, or a reason why there is none.

use tenax_hal_shim::channel::{Channel, sample_from_mv};
use tenax_hal_shim::words::Reason;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    pub low: u16,
    pub high: u16,
    pub stuck_after: u32,
    pub lost_after: u32,
    pub back_after: u32,
}

impl Limits {
    /// Lost after 25 ms of bad readings, back after 1 s of good ones, stuck after 2 s of equal ones.
    pub const fn of(channel: &Channel, per_second: u32) -> Self {
        let lost_after = per_second / 40;
        Self {
            low: sample_from_mv(channel.low_mv),
            high: sample_from_mv(channel.high_mv),
            stuck_after: 2 * per_second,
            lost_after: if lost_after == 0 { 1 } else { lost_after },
            back_after: per_second,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    Lost(Reason),
    Back,
}

#[derive(Clone, Debug, Default)]
pub struct SensorHealth {
    /// Previous 14-bit sample; 0 at start.
    last: u16,
    /// Readings in a row that equal the one before them.
    pub same: u32,
    bad: u32,
    good: u32,
    pub lost: Option<Reason>,
}

impl SensorHealth {
    /// True, and counted, if in range, different from the last, and not lost: the usual case.
    #[inline]
    #[must_use]
    pub fn is_plain(&mut self, limits: &Limits, sample: u16) -> bool {
        let plain =
            sample >= limits.low && sample <= limits.high && self.last != sample && self.lost.is_none();
        if plain {
            self.was_plain(sample);
        }
        plain
    }

    pub const fn was_plain(&mut self, last: u16) {
        self.last = last;
        self.same = 0;
        self.bad = 0;
    }

    /// [`take`](Self::take), with the usual case inlined.
    #[inline]
    pub fn read(&mut self, limits: &Limits, sample: u16) -> (Result<u16, Reason>, Option<Change>) {
        if self.is_plain(limits, sample) { (Ok(sample), None) } else { self.take(limits, sample) }
    }

    pub fn take(&mut self, limits: &Limits, sample: u16) -> (Result<u16, Reason>, Option<Change>) {
        self.same = if self.last == sample { self.same.saturating_add(1) } else { 0 };
        self.last = sample;
        let verdict = if sample < limits.low {
            Err(Reason::Dead)
        } else if sample > limits.high {
            Err(Reason::Saturated)
        } else if self.same >= limits.stuck_after {
            Err(Reason::Stuck)
        } else {
            Ok(sample)
        };
        match (verdict, self.lost) {
            (Ok(_), None) => {
                self.bad = 0;
                (verdict, None)
            }
            (Ok(_), Some(reason)) => {
                self.good += 1;
                if self.good < limits.back_after {
                    return (Err(reason), None);
                }
                *self = Self { last: self.last, ..Self::default() };
                (verdict, Some(Change::Back))
            }
            (Err(reason), None) => {
                self.bad += 1;
                if self.bad < limits.lost_after && reason != Reason::Stuck {
                    return (verdict, None);
                }
                self.lost = Some(reason);
                self.good = 0;
                (verdict, Some(Change::Lost(reason)))
            }
            (Err(_), Some(_)) => {
                self.good = 0;
                (verdict, None)
            }
        }
    }

    /// Lost although its readings are valid: back after `back_after` of them without another call.
    pub fn lose(&mut self, reason: Reason) -> Option<Change> {
        self.good = 0;
        let is_new = self.lost.is_none();
        self.lost.get_or_insert(reason);
        is_new.then_some(Change::Lost(reason))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits { low: 100, high: 16_000, stuck_after: 20, lost_after: 3, back_after: 5 };

    fn run(samples: impl IntoIterator<Item = u16>) -> (Result<u16, Reason>, std::vec::Vec<Change>) {
        let mut health = SensorHealth::default();
        let mut changes = std::vec::Vec::new();
        let mut last = Err(Reason::Dead);
        for sample in samples {
            let (reading, change) = health.take(&LIMITS, sample);
            last = reading;
            changes.extend(change);
        }
        (last, changes)
    }

    #[test]
    fn one_bad_reading_has_no_value_but_is_no_lost_sensor() {
        assert_eq!(run([500, 501, 0]), (Err(Reason::Dead), std::vec![]));
        assert_eq!(run([500, 501, 0, 502]), (Ok(502), std::vec![]));
    }

    #[test]
    fn each_fault_is_named_once() {
        assert_eq!(run([0; 9]), (Err(Reason::Dead), std::vec![Change::Lost(Reason::Dead)]));
        assert_eq!(run([16_380; 9]), (Err(Reason::Saturated), std::vec![Change::Lost(Reason::Saturated)]));
        assert_eq!(run([700; 30]), (Err(Reason::Stuck), std::vec![Change::Lost(Reason::Stuck)]));
    }

    #[test]
    fn a_sensor_that_comes_back_has_to_prove_it() {
        let mut samples = std::vec![0; 9];
        samples.extend([500, 501, 502, 503]);
        assert_eq!(run(samples.clone()).0, Err(Reason::Dead));
        samples.push(504);
        assert_eq!(run(samples), (Ok(504), std::vec![Change::Lost(Reason::Dead), Change::Back]));
    }
}
