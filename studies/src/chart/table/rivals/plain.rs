//! The simplest rivals of the detectors: loudness, a ratio of forces, a logistic regression.

/// How loud the loudest film is, without a filter for hum, impacts or a film that is doubted.
#[derive(Clone, Debug, Default)]
pub struct Loudness {
    /// Each film's slow mean, and the envelope of what is left; 8 bits are fractions.
    films: [(i32, i32); 12],
}

impl Loudness {
    /// Takes a frame's samples (2 kHz): the greatest envelope, samples with 4 fraction bits.
    pub fn step(&mut self, pvdf: &[u16; 12]) -> i32 {
        let mut loudest = 0;
        for ((mean, envelope), &sample) in self.films.iter_mut().zip(pvdf) {
            let sample = i32::from(sample) << 8;
            // The first sample is where the film rests.
            if *mean == 0 {
                *mean = sample;
            }
            // 16 ms, so from 10 Hz on; 8 ms.
            *mean += (sample - *mean) >> 5;
            *envelope += ((sample - *mean).abs() - *envelope) >> 4;
            loudest = loudest.max(*envelope);
        }
        loudest >> 4
    }
}

/// Shear over normal force, per mille; nothing below a tenth of a newton.
pub fn ratio_permille(ft_mn: i32, fn_mn: i32) -> i32 {
    if fn_mn < 100 { 0 } else { ft_mn.saturating_mul(1_000) / fn_mn }
}

/// A logistic regression's logit, 8 fraction bits: weights have 16, features 9.
pub fn logit(weights: &[i32], bias: i32, features: &[i16]) -> i32 {
    let sum: i64 =
        weights.iter().zip(features).map(|(&weight, &feature)| i64::from(weight) * i64::from(feature)).sum();
    (sum >> 17) as i32 + bias
}
