//! Strain gauges: reading less zero is load. The zero follows the readings while the finger is unloaded, since
//! a foil gauge drifts by some mV a minute, and is held in a grasp.

use tenax_hal_shim::channel::{CHANNELS, SLOW_HZ, STRAIN, STRAIN_COUNT, sample_from_mv};
use tenax_hal_shim::words::Reason;

use crate::health::{Change, Limits, SensorHealth};

const Q: u32 = 4;
const FOLLOW_SHIFT: u32 = 6;
static LIMITS: Limits = Limits::of(&CHANNELS[STRAIN], SLOW_HZ);
const REST: i32 = (sample_from_mv(CHANNELS[STRAIN].rest_mv) as i32) << (Q + FOLLOW_SHIFT);

#[derive(Clone, Debug)]
struct Gauge {
    health: SensorHealth,
    /// Samples, 4 + 6 fraction bits, so that the smallest load still moves it.
    zero: i32,
    load: i32,
}

#[derive(Clone, Debug)]
pub struct Gauges([Gauge; STRAIN_COUNT]);

impl Default for Gauges {
    fn default() -> Self {
        Self(core::array::from_fn(|_| Gauge { health: SensorHealth::default(), zero: REST, load: 0 }))
    }
}

impl Gauges {
    pub fn read(&mut self, gauge: usize, sample: u16, unloaded: bool) -> Option<Change> {
        let gauge = self.0.get_mut(gauge)?;
        let (reading, change) = gauge.health.read(&LIMITS, sample);
        gauge.set(reading, unloaded);
        change
    }

    pub fn zero(&mut self) {
        for gauge in &mut self.0 {
            gauge.zero += gauge.load << FOLLOW_SHIFT;
            gauge.load = 0;
        }
    }

    pub fn load(&self, gauge: usize) -> Option<i32> {
        self.0.get(gauge).map(|gauge| gauge.load)
    }

    /// 1/16 of a sample, positive or negative; 0 of a lost gauge.
    pub fn loads(&self) -> [i32; STRAIN_COUNT] {
        core::array::from_fn(|n| self.0[n].load)
    }
}

impl Gauge {
    fn set(&mut self, reading: Result<u16, Reason>, unloaded: bool) {
        // 14 bits, 4 and 6: nothing here leaves 32.
        self.load = reading.map_or(0, |sample| (i32::from(sample) << Q) - (self.zero >> FOLLOW_SHIFT));
        if unloaded {
            self.zero += self.load;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noisy(mv: u32, n: u16) -> u16 {
        sample_from_mv(mv) + n % 2
    }

    #[test]
    fn an_offset_is_gone_after_some_seconds_without_load_and_load_is_not() {
        let mut gauges = Gauges::default();
        (0..80 * 6).for_each(|n| _ = gauges.read(3, noisy(1_700, n), true));
        assert!(gauges.loads()[3].abs() <= (1 << Q) * 2, "{:?}", gauges.loads());
        (0..80 * 60).for_each(|n| _ = gauges.read(3, noisy(1_900, n), false));
        let load = gauges.loads()[3] >> Q;
        assert!((990..=996).contains(&load), "{load} samples for 200 mV");
        gauges.zero();
        assert_eq!(gauges.loads(), [0; STRAIN_COUNT]);
    }

    #[test]
    fn a_gauge_without_a_number_carries_no_load_and_loses_no_zero() {
        let mut gauges = Gauges::default();
        let change = (0..80).find_map(|_| gauges.read(0, 0, true));
        assert_eq!(change, Some(Change::Lost(Reason::Dead)));
        assert_eq!(gauges.loads()[0], 0);
        (0..81).for_each(|n| _ = gauges.read(0, noisy(1_650, n), false));
        assert!(gauges.loads()[0].abs() <= 1 << Q);
        assert_eq!(gauges.read(STRAIN_COUNT, 0, true), None);
    }
}
