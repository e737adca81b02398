//! A photoelastic head in the place of PVDF film 12 (Dubey 2006): one optical channel for slip (ac) and normal
//! force (dc).
//!
//! | step | module | how often |
//! |---|---|---|
//! | ac and dc apart | [`split`] | every frame |
//! | whether it slips | [`slip`] | every frame |
//! | dc to a phase, and both forces it can mean | [`curve`] | every cycle |
//! | which of them, whatever the shear | [`track`] | every cycle |
//! | how fast it slips | [`rate`] | every cycle, if asked |

pub mod curve;
mod detector;
pub mod rate;
pub mod settings;
pub mod slip;
pub mod split;
pub mod track;

use tenax_hal_shim::channel::{CHANNELS, FRAME_HZ, HEAD, SAMPLE_MAX};
use tenax_hal_shim::wire::Forces;

use self::curve::ONE;
pub use self::detector::PhotoelasticDetector;
use self::rate::RateFit;
pub use self::settings::HeadConfig;
use self::slip::Presence;
use self::split::{Q, Split};
use self::track::{Force, Hints, Track, Tracker};
use crate::health::{Change, Limits, SensorHealth};

/// The head's amplifier clips inside of its supply, so a pin against either end is broken.
const LIMITS: Limits = {
    let limits = Limits::of(&CHANNELS[HEAD], FRAME_HZ);
    Limits { low: SAMPLE_MAX / 33, high: SAMPLE_MAX - SAMPLE_MAX / 40, ..limits }
};

/// Fit of the slip rate on aluminium, from six heads (seeds 1 to 6): 19 % median error on them, 24 % on other heads. A fit to
/// the head itself has half the error.
pub const ALUMINIUM: RateFit = RateFit { constant: -16_736, amplitude: 896, frequency: 846, force: 21 };

/// The head.
#[derive(Clone, Debug, Default)]
pub struct Head {
    health: SensorHealth,
    is_usable: bool,
    split: Split,
    presence: Presence,
    tracker: Tracker,
}

impl Head {
    /// Takes a 14-bit sample. Gives a change of the sensor's health.
    #[inline]
    pub fn process(&mut self, config: &HeadConfig, sample: u16) -> Option<Change> {
        if self.health.is_plain(&LIMITS, sample) {
            self.is_usable = true;
            self.split.process(sample);
            self.presence.process(config.slip, &self.split);
            return None;
        }
        self.take_odd(config, sample)
    }

    #[inline(never)]
    fn take_odd(&mut self, config: &HeadConfig, sample: u16) -> Option<Change> {
        let (reading, change) = self.health.take(&LIMITS, sample);
        self.is_usable = reading.is_ok();
        match reading {
            Ok(sample) => {
                self.split.process(sample);
                self.presence.process(config.slip, &self.split);
            }
            Err(_) => self.lose(),
        }
        change
    }

    /// The sample is not valid. Resets the filters, so that the jump when samples return is no vibration.
    fn lose(&mut self) {
        self.split = Split::default();
        self.presence = Presence::default();
    }

    /// A frame was lost: only its time has passed.
    pub fn miss(&mut self) {
        self.split.miss();
        self.presence = Presence::default();
    }

    /// Ends a slow frame: computes the force from the mean of its samples.
    pub fn cycle(&mut self, config: &HeadConfig, hints: Hints) {
        let level_q4 = self.split.take_mean_q4().filter(|_| self.is_usable);
        self.tracker.step(&config.curve, level_q4, hints);
    }

    /// Whether the head gives valid readings.
    pub const fn is_usable(&self) -> bool {
        self.is_usable
    }

    /// Whether the ac part has the size and the swings of slip.
    pub const fn vibrates(&self) -> bool {
        self.presence.is_slip()
    }

    /// Mean size of the ac part, samples (14 bits).
    pub const fn level(&self) -> i32 {
        self.split.envelope() >> Q
    }

    /// The two parts of the signal.
    pub const fn split(&self) -> &Split {
        &self.split
    }

    /// Returns whether the present force is known to be on the rising or the falling branch of the calibration curve.
    pub const fn track(&self) -> Track {
        self.tracker.track()
    }

    /// The force, None while none is known.
    pub fn force(&self) -> Option<Force> {
        self.tracker.force()
    }

    /// Input of the rate: the ac part's size as a part of the span (Q20), the period (1/16 of a frame) and the force (mN). None while
    /// nothing oscillates or the force is unknown.
    #[must_use]
    pub fn swing(&self, config: &HeadConfig) -> Option<(i32, u16, i32)> {
        let period_q4 = self.split.period_q4();
        let force_mn = self.force()?.mn();
        let span = i64::from(config.curve.bright_q4 - config.curve.dark_q4).max(1);
        let part = i64::from(self.split.envelope()) * 16 * i64::from(ONE) / (span << Q);
        (period_q4 > 0).then_some((part.min(i64::from(ONE)) as i32, period_q4, force_mn))
    }

    /// Rate of slip, um/s; 0 if it is unknown.
    #[must_use]
    pub fn rate_um_s(&self, config: &HeadConfig, fit: &RateFit) -> i32 {
        self.swing(config).map_or(0, |(part, period_q4, force_mn)| fit.rate_um_s(part, period_q4, force_mn))
    }

    /// Forces in place of a force sensor without a number. Each errs to its safe side, for any shear: Fn, which friction
    /// uses, is the least force that fits the light, and the load is the most, so that neither a ceiling nor an
    /// empty hand is missed. Shear is 0 and the ratio None. None without a reading.
    pub fn stand_in(&self) -> Option<Forces> {
        let Force { least_mn, most_mn } = self.force()?;
        Some(Forces { fn_mn: least_mn, fx_mn: 0, fy_mn: 0, ft_mn: 0, load_mn: most_mn, ratio_permille: None })
    }
}
