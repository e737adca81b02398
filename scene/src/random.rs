//! Noise: one numbered stream for each source, so that a source added later changes no other one's noise.

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seeds {
    pub making: u64,
    pub noise: u64,
}

impl From<u64> for Seeds {
    fn from(seed: u64) -> Self {
        Self { making: seed, noise: seed }
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Source {
    /// Gains, signs and depths of the PVDF films.
    FilmMaking,
    Film,
    Myo,
    Converter,
    StrainMaking,
    Strain,
    ArrayMaking,
    Array,
    ArraySlips,
    Camera,
    ArraySurface,
    Skin,
    Picture,
    PictureNoise,
    HeadMaking,
    HeadStrip,
    HeadDay,
    Head,
    SkinMistakes,
    Fsr,
    Drawn,
}

#[derive(Debug)]
pub(crate) struct Noise(ChaCha8Rng);

impl Noise {
    pub(crate) fn new(seed: u64, source: Source) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(source as u64);
        Self(rng)
    }

    /// Normally distributed, mean 0, standard deviation 1, within 4; excess kurtosis -0.04, ends at 7. Of a draw of 64 bits, 48 are coins,
    /// whose heads are binomial, and 16 fill the gaps between the counts evenly: no function of any platform's.
    pub(crate) fn normal(&mut self) -> f64 {
        let [one] = self.normals();
        one
    }

    pub(crate) fn normals<const N: usize>(&mut self) -> [f64; N] {
        const COINS: u32 = 48;
        // The variances of the count, a quarter a coin, and of the gap's filling.
        const VARIANCE: f64 = COINS as f64 / 4.0 + 1.0 / 12.0;
        const DEVIATION: f64 = 3.476_108_935_769_035;
        const { assert!((DEVIATION * DEVIATION - VARIANCE).abs() < 1e-12) };
        // As whole numbers: a head is 2^17, and the filling an odd number around 0.
        const HEAD: i32 = 1 << 17;
        const MIDDLE: i32 = COINS as i32 / 2 * HEAD + HEAD / 2;
        let mut bits = [0_u64; N];
        self.0.fill(&mut bits);
        bits.map(|bits| {
            let heads = (bits >> (u64::BITS - COINS)).count_ones() as i32;
            let filled = 2 * i32::from(bits as u16) + 1;
            f64::from(heads * HEAD + filled - MIDDLE) * (1.0 / DEVIATION / HEAD as f64)
        })
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    pub(crate) fn sign(&mut self) -> f64 {
        if self.0.random::<bool>() { 1.0 } else { -1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_is_normal_to_the_fourth_moment() {
        const DRAWS: u32 = 1_000_000;
        let mut noise = Noise::new(1, Source::Film);
        let (mut sums, mut beyond) = ([0.0; 4], [0_u32; 3]);
        for _ in 0..DRAWS {
            let draw = noise.normal();
            (0..4).for_each(|power| sums[power] += draw.powi(power as i32 + 1));
            (0..3).for_each(|n| beyond[n] += u32::from(draw.abs() > (n + 1) as f64));
        }
        let [mean, variance, skew, kurtosis] = sums.map(|sum| sum / f64::from(DRAWS));
        assert!(mean.abs() < 0.004 && (variance - 1.0).abs() < 0.006, "{mean}, {variance}");
        assert!(skew.abs() < 0.012 && (kurtosis - 3.0).abs() < 0.07, "{skew}, {kurtosis}");
        for (beyond, normal) in beyond.into_iter().zip([0.3173, 0.0455, 0.0027]) {
            let part = f64::from(beyond) / f64::from(DRAWS);
            assert!((part / normal - 1.0).abs() < 0.15, "{part} for {normal}");
        }
    }
}
