//! The verdict: features, network and a threshold with hysteresis.

use core::ops::Range;

use tenax_hal_shim::channel::SLOW_HZ;
use tenax_hal_shim::detector::{DetectorHealth, DetectorId, Direction};
use tenax_hal_shim::schedule::ARRAY_SHARES;

use super::network::Mlp;
use super::preprocess::{Preprocessor, PreprocessorConfig};
use super::{ARRAY_READ, Aligned, HIDDEN, Reading, ShippedDetector};
use crate::detectors::{Description, Detector, Said, Sensed};

/// Shares of a slow frame's work, one a tick. 0: covariance, spectrum. 1: features of the spectrum, short
/// lags. 2: long lags, units of the first layer. 3: more units. 4: the rest, and the verdict.
pub const SHARES: usize = ARRAY_SHARES as usize;
const H1: usize = HIDDEN[0];
const SEEN: [usize; 2] = [8, 24];
const VERDICT_SHARE: usize = SHARES - 1;
const _: () = assert!(VERDICT_SHARE == 4);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArrayVerdict {
    pub slip: bool,
    /// Logistic function of the calibrated logit, 0 to 1000 per mille.
    pub confidence_permille: u16,
    /// Time since the last valid features, ms, saturating at 65 535; 0 while it works.
    pub age_ms: u16,
}

impl ArrayVerdict {
    pub const NONE: Self = Self { slip: false, confidence_permille: 0, age_ms: u16::MAX };
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Judgement {
    pub logit_per_nat: i32,
    /// Confidences at which slip begins and ends, per mille.
    pub on_permille: u16,
    pub off_permille: u16,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    pub preprocessor: PreprocessorConfig,
    pub network: Mlp,
    pub judgement: Judgement,
}

#[derive(Clone, Debug)]
pub struct ArrayDetector<'m> {
    model: &'m Model,
    preprocessor: Preprocessor,
    unjudged: u16,
    felt: bool,
    seen: Aligned<[i16; H1]>,
    logit: Option<i32>,
    verdict: ArrayVerdict,
}

impl<'m> ArrayDetector<'m> {
    pub fn new(model: &'m Model) -> Self {
        Self {
            model,
            preprocessor: Preprocessor::new(model.preprocessor),
            unjudged: u16::MAX,
            felt: false,
            seen: Aligned([0; H1]),
            logit: None,
            verdict: ArrayVerdict::NONE,
        }
    }

    /// Verdict of one slow frame. Without features: no slip, confidence 0, and a growing age.
    pub fn push(&mut self, reading: &Reading) -> ArrayVerdict {
        (0..SHARES).for_each(|share| _ = self.work(share, reading));
        self.verdict
    }

    /// One share of [`push`](Self::push), in order; the verdict with the last. Only share 0 uses `reading`.
    pub fn work(&mut self, share: usize, reading: &Reading) -> Option<ArrayVerdict> {
        match share {
            0 => self.preprocessor.add_reading(reading),
            1 => self.preprocessor.add_spectrum(),
            2 => {
                self.felt = self.preprocessor.finish().is_some();
                self.see(0..SEEN[0]);
            }
            3 => self.see(SEEN[0]..SEEN[1]),
            VERDICT_SHARE => {
                self.see(SEEN[1]..H1);
                return Some(self.decide());
            }
            _ => {}
        }
        None
    }

    fn see(&mut self, units: Range<usize>) {
        if self.felt {
            self.model.network.first.activate(self.preprocessor.features(), units, &mut self.seen.0);
        }
    }

    fn decide(&mut self) -> ArrayVerdict {
        self.logit = core::mem::take(&mut self.felt).then(|| self.model.network.judge(&self.seen));
        match self.logit {
            Some(logit) => self.judge(logit),
            None => self.stand_down(),
        }
        self.verdict
    }

    pub fn logit(&self) -> Option<i32> {
        self.logit
    }

    /// Log-odds of slip, millinats.
    pub fn millinats(&self) -> Option<i32> {
        self.logit.map(|logit| logit / (self.model.judgement.logit_per_nat / 1_000).max(1))
    }

    pub fn verdict(&self) -> ArrayVerdict {
        self.verdict
    }

    fn judge(&mut self, logit: i32) {
        let Judgement { logit_per_nat, on_permille, off_permille } = self.model.judgement;
        let confidence_permille = logistic_permille(logit, logit_per_nat);
        let from = if self.verdict.slip { off_permille } else { on_permille };
        self.unjudged = 0;
        self.verdict = ArrayVerdict { slip: confidence_permille >= from, confidence_permille, age_ms: 0 };
    }

    fn stand_down(&mut self) {
        self.unjudged = self.unjudged.saturating_add(1);
        let age_ms = u32::from(self.unjudged) * 1_000 / SLOW_HZ;
        let age_ms =
            if self.unjudged == u16::MAX { u16::MAX } else { age_ms.min(u32::from(u16::MAX)) as u16 };
        self.verdict = ArrayVerdict { slip: false, confidence_permille: 0, age_ms };
    }
}

impl Detector for ShippedDetector {
    const ID: DetectorId = DetectorId::Mlp;
    type Config = ();

    /// Lost frames do their share too, or an old verdict would stand.
    fn step(&mut self, _config: &(), sensed: &Sensed<'_>) -> Option<Said> {
        let share = sensed.slot.checked_sub(ARRAY_READ)?;
        self.work(share.into(), sensed.taxels).map(|verdict| Said::slip(verdict.slip))
    }

    fn describe(&self, _config: &()) -> Description {
        let verdict = self.verdict();
        Description {
            confidence_permille: verdict.confidence_permille,
            direction: Direction::Unknown,
            health: match verdict.age_ms {
                0 => DetectorHealth::Working,
                u16::MAX => DetectorHealth::Starting,
                _ => DetectorHealth::Blind,
            },
            raw: self.logit().unwrap_or(0),
        }
    }
}

const LOGISTIC: [u16; 33] = [
    500, 562, 622, 679, 731, 777, 818, 852, 881, 905, 924, 940, 953, 963, 971, 977, 982, 986, 989, 991, 993,
    995, 996, 997, 998, 998, 998, 999, 999, 999, 999, 1_000, 1_000,
];

/// `1000 / (1 + exp(-logit / per_nat))`, per mille, interpolated between points a quarter apart; error at
/// most 3. `per_nat` below 1 counts as 1.
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
