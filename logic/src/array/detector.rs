//! The verdict: features, network and a threshold with hysteresis.

use core::ops::Range;

use tenax_hal_shim::channel::SLOW_HZ;
use tenax_hal_shim::schedule::ARRAY_SHARES;

use super::network::{LookBack, Mlp};
use super::preprocess::{Features, Preprocessor, PreprocessorConfig};
use super::{COVARIANCE_WINDOW, FEATURES, Reading, SPECTRUM_WINDOW};

/// Number of shares of a slow frame's work, one a tick, about equally long: all of it would not fit into one tick. Share 0:
/// covariance, its features, spectrum. 1: features of the spectrum, structure functions of short lags. 2: those of long lags, a
/// quarter of the first layer. 3: half of the first layer. 4: the rest of the network, and the verdict.
pub const SHARES: usize = ARRAY_SHARES as usize;
const VERDICT_SHARE: usize = SHARES - 1;
const _: () = assert!(VERDICT_SHARE == 4);

/// Verdict of the normal-force array (Bamshad 2023).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArrayVerdict {
    /// Whether the object slips.
    pub slip: bool,
    /// Probability of slip, 0 to 1000 per mille: the calibrated logit's logistic function.
    pub confidence_permille: u16,
    /// Time since the detector last had valid features, at the end of the last slow frame, ms, at most 65 535; 0 while it works.
    pub age_ms: u16,
}

impl ArrayVerdict {
    /// The verdict before the first features.
    pub const NONE: Self = Self { slip: false, confidence_permille: 0, age_ms: u16::MAX };
}

/// Calibration and thresholds of the logit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Judgement {
    /// Increase of the logit that multiplies the odds of slip by e: the calibration.
    pub logit_per_nat: i32,
    /// Slow frames with at least this confidence count as slip, per mille.
    pub on_permille: u16,
    /// Slow frames with less confidence count as no slip, per mille.
    pub off_permille: u16,
    /// Number of consecutive slip frames after which slip is reported.
    pub on_frames: u8,
    /// Number of consecutive frames without slip after which the report ends.
    pub off_frames: u8,
}

/// Constants of a trained detector on windows of `N` differences and `M` sums.
#[derive(Clone, Debug, PartialEq)]
pub struct Model<
    const H1: usize,
    const L: usize,
    const H2: usize,
    const N: usize = COVARIANCE_WINDOW,
    const M: usize = SPECTRUM_WINDOW,
> {
    /// Settings of the network's features.
    pub preprocessor: PreprocessorConfig,
    /// The network.
    pub network: Mlp<FEATURES, H1, L, H2>,
    /// Calibration of the network's logit, and the thresholds of the verdict.
    pub judgement: Judgement,
}

/// Slip detector of ten taxels (Bamshad 2023): features, the network of a [`Model`], and the verdict with its two thresholds.
#[derive(Clone, Debug)]
pub struct ArrayDetector<
    'm,
    const H1: usize,
    const L: usize,
    const H2: usize,
    const N: usize = COVARIANCE_WINDOW,
    const M: usize = SPECTRUM_WINDOW,
> {
    model: &'m Model<H1, L, H2, N, M>,
    preprocessor: Preprocessor<N, M>,
    look_back: LookBack<H1, L>,
    /// Slow frames in a row that contradict the verdict.
    contradicted: u8,
    /// Slow frames since the last one that was judged.
    unjudged: u16,
    /// Whether the last features still wait for the network.
    felt: bool,
    /// Activations of the first layer, computed in the last three shares.
    seen: [i16; H1],
    logit: Option<i32>,
    verdict: ArrayVerdict,
}

impl<'m, const H1: usize, const L: usize, const H2: usize, const N: usize, const M: usize>
    ArrayDetector<'m, H1, L, H2, N, M>
{
    /// A detector without readings.
    pub fn new(model: &'m Model<H1, L, H2, N, M>) -> Self {
        Self {
            model,
            preprocessor: Preprocessor::new(model.preprocessor),
            look_back: LookBack::default(),
            contradicted: 0,
            unjudged: u16::MAX,
            felt: false,
            seen: [0; H1],
            logit: None,
            verdict: ArrayVerdict::NONE,
        }
    }

    /// Takes the readings of one slow frame and returns the verdict.
    ///
    /// While there are no features (windows not full, too many elements dead) the verdict is no slip, confidence 0, and
    /// an age, ms, that grows until there are features again.
    pub fn push(&mut self, reading: &Reading) -> ArrayVerdict {
        (0..SHARES).for_each(|share| _ = self.work(share, reading));
        self.verdict
    }

    /// Does one share of [`push`](Self::push), 0 to [`SHARES`] less one in this order, and gives the verdict with the last.
    /// Only share 0 uses `reading`; a larger share does nothing.
    pub fn work(&mut self, share: usize, reading: &Reading) -> Option<ArrayVerdict> {
        match share {
            0 => self.preprocessor.add_reading(reading),
            1 => self.preprocessor.add_spectrum(),
            2 => {
                self.felt = self.preprocessor.finish().is_some();
                self.see(0..H1 / 4);
            }
            3 => self.see(H1 / 4..H1 * 3 / 4),
            VERDICT_SHARE => {
                self.see(H1 * 3 / 4..H1);
                return Some(self.decide());
            }
            _ => {}
        }
        None
    }

    /// Some units of the first layer.
    fn see(&mut self, units: Range<usize>) {
        if self.felt {
            self.model.network.see_some(self.preprocessor.features(), units, &mut self.seen);
        }
    }

    fn decide(&mut self) -> ArrayVerdict {
        self.logit = self.evidence();
        match self.logit {
            Some(logit) => self.judge(logit),
            None => self.stand_down(),
        }
        self.verdict
    }

    fn evidence(&mut self) -> Option<i32> {
        if !core::mem::take(&mut self.felt) {
            self.look_back.clear();
            return None;
        }
        Some(self.model.network.judge(self.look_back.push(self.seen)?))
    }

    /// The network's logit of the last slow frame. None without features.
    pub fn logit(&self) -> Option<i32> {
        self.logit
    }

    /// The last features. Invalid while [`logit`](Self::logit) is None.
    pub fn features(&self) -> &Features {
        self.preprocessor.features()
    }

    /// The last verdict.
    pub fn verdict(&self) -> ArrayVerdict {
        self.verdict
    }

    fn judge(&mut self, logit: i32) {
        let Judgement { logit_per_nat, on_permille, off_permille, on_frames, off_frames } =
            self.model.judgement;
        let confidence_permille = logistic_permille(logit, logit_per_nat);
        let slip = self.verdict.slip;
        let contradicts =
            if slip { confidence_permille < off_permille } else { confidence_permille >= on_permille };
        self.contradicted = if contradicts { self.contradicted.saturating_add(1) } else { 0 };
        let turns = contradicts && self.contradicted >= if slip { off_frames } else { on_frames };
        if turns {
            self.contradicted = 0;
        }
        self.unjudged = 0;
        self.verdict = ArrayVerdict { slip: slip != turns, confidence_permille, age_ms: 0 };
    }

    fn stand_down(&mut self) {
        self.contradicted = 0;
        self.unjudged = self.unjudged.saturating_add(1);
        let age_ms = u32::from(self.unjudged) * 1_000 / SLOW_HZ;
        let age_ms =
            if self.unjudged == u16::MAX { u16::MAX } else { age_ms.min(u32::from(u16::MAX)) as u16 };
        self.verdict = ArrayVerdict { slip: false, confidence_permille: 0, age_ms };
    }
}

/// Points of the logistic function, four to a unit.
const LOGISTIC: [u16; 33] = [
    500, 562, 622, 679, 731, 777, 818, 852, 881, 905, 924, 940, 953, 963, 971, 977, 982, 986, 989, 991, 993,
    995, 996, 997, 998, 998, 998, 999, 999, 999, 999, 1_000, 1_000,
];

/// Returns the logistic function of a logit, 0 to 1000 per mille: `1000 / (1 + exp(-logit / per_nat))`, interpolated
/// between points a quarter apart. The error is at most 3. `per_nat` is the rise of the logit that multiplies the
/// odds by e; a value below 1 counts as 1.
#[must_use]
pub fn logistic_permille(logit: i32, per_nat: i32) -> u16 {
    let per_nat = i64::from(per_nat.max(1));
    let quarters = i64::from(logit).abs() * 4;
    let (whole, part) = (quarters / per_nat, quarters % per_nat);
    let last = i64::from(LOGISTIC[LOGISTIC.len() - 1]);
    let at = |n: i64| usize::try_from(n).ok().and_then(|n| LOGISTIC.get(n)).map_or(last, |&p| i64::from(p));
    let above = at(whole) + (at(whole + 1) - at(whole)) * part / per_nat;
    (if logit < 0 { 1_000 - above } else { above }) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_logistic_function_is_within_three_per_mille() {
        for per_nat in [1, 7, 1_000, 1 << 16, 1 << 28] {
            for step in -400..=400 {
                let logit = (f64::from(step) / 40.0 * f64::from(per_nat)) as i32;
                let exact = 1_000.0 / (1.0 + (-f64::from(logit) / f64::from(per_nat)).exp());
                let found = f64::from(logistic_permille(logit, per_nat));
                assert!((found - exact).abs() <= 3.0, "{logit} {per_nat}: {found} {exact}");
            }
        }
        assert_eq!(logistic_permille(i32::MIN, 1), 0);
        assert_eq!(logistic_permille(i32::MAX, 0), 1_000);
    }
}
