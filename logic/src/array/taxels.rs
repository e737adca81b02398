//! The taxels of the normal-force array: which of their readings are valid.

use tenax_hal_shim::channel::{ARRAY, ARRAY_COUNT, CHANNELS, SLOW_HZ};

use super::Reading;
use crate::health::{Change, Limits, SensorHealth};

static LIMITS: Limits = Limits::of(&CHANNELS[ARRAY], SLOW_HZ);

#[derive(Clone, Debug, Default)]
pub struct Taxels {
    health: [SensorHealth; ARRAY_COUNT],
    reading: Reading,
}

impl Taxels {
    pub fn read(&mut self, element: usize, sample: u16) -> Option<Change> {
        let (health, slot) = (self.health.get_mut(element)?, self.reading.get_mut(element)?);
        let (reading, change) = health.read(&LIMITS, sample);
        *slot = reading.ok();
        change
    }

    pub fn lose(&mut self, element: usize) {
        if let Some(slot) = self.reading.get_mut(element) {
            *slot = None;
        }
    }

    pub const fn reading(&self) -> &Reading {
        &self.reading
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_element_whose_frame_was_lost_has_no_reading_until_the_next() {
        let mut taxels = Taxels::default();
        (0..ARRAY_COUNT).for_each(|element| _ = taxels.read(element, 2_000));
        taxels.lose(3);
        taxels.lose(ARRAY_COUNT);
        let expected: Reading = core::array::from_fn(|element| (element != 3).then_some(2_000));
        assert_eq!(taxels.reading(), &expected);
        taxels.read(3, 2_001);
        assert_eq!(taxels.reading()[3], Some(2_001));
    }
}
