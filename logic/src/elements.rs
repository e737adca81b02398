//! The taxels of the normal-force array: which of their readings are valid.

use tenax_hal_shim::channel::{ARRAY, ARRAY_COUNT, CHANNELS, SLOW_HZ};

use crate::array::Reading;
use crate::health::{Change, Limits, SensorHealth};

static LIMITS: Limits = Limits::of(&CHANNELS[ARRAY], SLOW_HZ);

/// The ten elements.
#[derive(Clone, Debug, Default)]
pub struct Elements {
    health: [SensorHealth; ARRAY_COUNT],
    reading: Reading,
}

impl Elements {
    /// Takes a reading of one element (14 bits).
    pub fn take(&mut self, element: usize, sample: u16) -> Option<Change> {
        let (health, slot) = (self.health.get_mut(element)?, self.reading.get_mut(element)?);
        if health.is_plain(&LIMITS, sample) {
            *slot = Some(sample);
            return None;
        }
        let (reading, change) = health.take(&LIMITS, sample);
        *slot = reading.ok();
        change
    }

    /// The frame that shows this element was lost: what was read before is no reading of now.
    pub fn lose(&mut self, element: usize) {
        if let Some(slot) = self.reading.get_mut(element) {
            *slot = None;
        }
    }

    /// The last reading of every element.
    #[must_use]
    pub const fn reading(&self) -> &Reading {
        &self.reading
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_hal_shim::words::Reason;

    #[test]
    fn a_dead_element_has_no_reading_and_is_told_once() {
        let mut elements = Elements::default();
        assert_eq!(elements.take(2, 2_000), None);
        assert_eq!(elements.reading()[2], Some(2_000));
        let changes: std::vec::Vec<_> = (0..80).filter_map(|_| elements.take(2, 0)).collect();
        assert_eq!(changes, [Change::Lost(Reason::Dead)]);
        assert_eq!(elements.reading(), &Reading::default());
        assert_eq!(elements.take(ARRAY_COUNT, 2_000), None);
    }

    #[test]
    fn an_element_that_is_stuck_for_two_seconds_has_no_reading() {
        let mut elements = Elements::default();
        let lost_after = (0..400).position(|_| elements.take(0, 3_000).is_some());
        assert_eq!(lost_after, Some(160));
        assert_eq!(elements.reading()[0], None);
    }

    #[test]
    fn an_element_whose_frame_was_lost_has_no_reading_until_the_next() {
        let mut elements = Elements::default();
        (0..ARRAY_COUNT).for_each(|element| _ = elements.take(element, 2_000));
        elements.lose(3);
        elements.lose(ARRAY_COUNT);
        let expected: Reading = core::array::from_fn(|element| (element != 3).then_some(2_000));
        assert_eq!(elements.reading(), &expected);
        elements.take(3, 2_001);
        assert_eq!(elements.reading()[3], Some(2_001));
    }
}
