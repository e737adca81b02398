//! Activations of the tactile nodes: readings over their maximum (Tada 2006, section II.C), without the sign of
//! a vibration.

use dsp_fixedpoint::Q32;

use super::arithmetic::Reciprocal;

/// 2^26 is 1; within +-1.
pub type Activation = Q32<26>;
const RATIO_SHIFT: u32 = 30 - 26;
const RATIO_HALF: u32 = 1 << (RATIO_SHIFT - 1);
const ONE: i32 = 1 << 26;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// The sign is dropped: 0 to 1.
    Vibration,
    Pressure,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Activations<const N: usize>([i32; N]);

impl<const N: usize> Default for Activations<N> {
    fn default() -> Self {
        Self([0; N])
    }
}

impl<const N: usize> Activations<N> {
    pub fn new(activations: [Activation; N]) -> Self {
        Self(activations.map(|activation| activation.into_bits().clamp(-ONE, ONE)))
    }

    pub const fn as_bits(&self) -> &[i32; N] {
        &self.0
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NormaliserConfig<const N: usize> {
    pub senses: [Sense; N],
    /// Smallest maximum of each receptor, raw: a dead receptor's noise stays small. 0 counts as 1.
    pub floors: [u32; N],
    /// Range of the front end, raw: larger values clip.
    pub ceiling: u32,
    /// The maximum is that of an average over about `2^average_shift` readings, shift at most 16.
    pub average_shift: u32,
}

const AVERAGE_SHIFT_MAX: u32 = 16;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Scale {
    sum: u64,
    largest: u32,
    reciprocal: Reciprocal,
}

impl Scale {
    const fn new(largest: u32) -> Self {
        let largest = if largest == 0 { 1 } else { largest };
        Self { sum: 0, largest, reciprocal: Reciprocal::of(largest) }
    }

    fn activation(&self, sense: Sense, raw: i32) -> i32 {
        let ratio = self.reciprocal.ratio(raw.unsigned_abs().min(self.largest));
        let size = ((ratio + RATIO_HALF) >> RATIO_SHIFT) as i32;
        match sense {
            Sense::Pressure if raw < 0 => -size,
            Sense::Pressure | Sense::Vibration => size,
        }
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Normaliser<const N: usize> {
    scales: [Scale; N],
}

impl<const N: usize> Normaliser<N> {
    pub fn new(config: &NormaliserConfig<N>) -> Self {
        Self { scales: config.floors.map(|floor| Scale::new(floor.min(config.ceiling))) }
    }

    /// Lets the maxima rise. Call it only when learning is allowed.
    pub fn observe(&mut self, config: &NormaliserConfig<N>, raw: &[i32; N]) {
        let shift = config.average_shift.min(AVERAGE_SHIFT_MAX);
        for (scale, &raw) in self.scales.iter_mut().zip(raw) {
            let size = raw.unsigned_abs().min(config.ceiling);
            // The sum settles at 2^shift times the size and does not pass it.
            scale.sum = scale.sum - (scale.sum >> shift) + u64::from(size);
            let average = (scale.sum >> shift).min(u64::from(config.ceiling)) as u32;
            if average > scale.largest {
                *scale = Scale { sum: scale.sum, ..Scale::new(average) };
            }
        }
    }

    /// New readings of the receptors from `first` on, within 2^-25 of the exact quotient; the others stay.
    #[inline]
    pub fn renew(
        &self,
        config: &NormaliserConfig<N>,
        first: usize,
        raw: &[i32],
        activations: &mut Activations<N>,
    ) {
        // Slices: `skip` of an iterator would cost its steps.
        let (Some(scales), Some(senses), Some(slots)) =
            (self.scales.get(first..), config.senses.get(first..), activations.0.get_mut(first..))
        else {
            return;
        };
        for (((scale, &sense), slot), &raw) in scales.iter().zip(senses).zip(slots).zip(raw) {
            // Most films are quiet most of the time.
            *slot = if raw == 0 { 0 } else { scale.activation(sense, raw) };
        }
    }

    pub fn maxima(&self) -> [u32; N] {
        self.scales.map(|scale| scale.largest)
    }

    pub fn from_maxima(config: &NormaliserConfig<N>, maxima: &[u32; N]) -> Self {
        let mut normaliser = Self::new(config);
        for (scale, &largest) in normaliser.scales.iter_mut().zip(maxima) {
            *scale = Scale::new(largest.max(scale.largest).min(config.ceiling));
        }
        normaliser
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONFIG: NormaliserConfig<2> = NormaliserConfig {
        senses: [Sense::Vibration, Sense::Pressure],
        floors: [100, 100],
        ceiling: 1 << 30,
        average_shift: 0,
    };

    fn seen(normaliser: &Normaliser<2>, raw: [i32; 2]) -> [f64; 2] {
        let mut activations = Activations::default();
        normaliser.renew(&CONFIG, 0, &raw, &mut activations);
        activations.as_bits().map(|t| f64::from(t) / f64::from(ONE))
    }

    #[test]
    fn a_quotient_is_within_one_unit_of_f64() {
        for largest in [100, 101, 255, 256, 65_535, 1_000_003, 1 << 30] {
            let normaliser = Normaliser::from_maxima(&CONFIG, &[largest; 2]);
            for part in 0..=1_000u64 {
                let raw = (u64::from(largest) * part / 1_000) as i32;
                let exact = f64::from(raw) / f64::from(largest);
                for (t, sign) in seen(&normaliser, [-raw, -raw]).iter().zip([1.0, -1.0]) {
                    assert!((t - sign * exact).abs() <= 0.6 / f64::from(ONE), "{raw} / {largest}");
                }
            }
        }
    }

    #[test]
    fn a_spike_makes_no_receptor_deaf_and_a_level_is_learned() {
        let config = NormaliserConfig { average_shift: 6, ..CONFIG };
        let mut normaliser = Normaliser::new(&config);
        normaliser.observe(&config, &[8_100, 0]);
        assert_eq!(normaliser.maxima(), [126, 100]);
        for _ in 0..1_000 {
            normaliser.observe(&config, &[8_100, 0]);
        }
        assert!((8_090..=8_100).contains(&normaliser.maxima()[0]), "{:?}", normaliser.maxima());
        assert_eq!(normaliser.maxima()[1], 100);
    }
}
