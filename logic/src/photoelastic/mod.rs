//! A photoelastic head in the place of PVDF film 12 (Dubey 2006): one optical channel for slip (ac, every
//! frame) and normal force (dc, every slow frame).

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

/// Fit on aluminium, six heads (seeds 1 to 6): 19 % median error on them, 24 % on other heads.
pub const ALUMINIUM: RateFit = RateFit { constant: -16_736, amplitude: 896, frequency: 846, force: 21 };

#[derive(Clone, Debug, Default)]
pub struct Head {
    health: SensorHealth,
    pub is_usable: bool,
    pub split: Split,
    presence: Presence,
    tracker: Tracker,
}

impl Head {
    #[inline]
    pub fn process(&mut self, config: &HeadConfig, sample: u16) -> Option<Change> {
        let (reading, change) = self.health.read(&LIMITS, sample);
        self.is_usable = reading.is_ok();
        if self.is_usable {
            self.split.process(sample);
            self.presence.process(config.slip, &self.split);
        } else {
            // The jump when samples return is no vibration.
            (self.split, self.presence) = Default::default();
        }
        change
    }

    pub fn miss(&mut self) {
        self.split.miss();
        self.presence = Presence::default();
    }

    pub fn cycle(&mut self, config: &HeadConfig, hints: Hints) {
        let level_q4 = self.split.take_mean_q4().filter(|_| self.is_usable);
        self.tracker.step(&config.curve, level_q4, hints);
    }

    pub const fn vibrates(&self) -> bool {
        self.presence.slip
    }

    pub const fn level(&self) -> i32 {
        self.split.envelope >> Q
    }

    pub const fn track(&self) -> Track {
        self.tracker.track()
    }

    pub fn force(&self) -> Option<Force> {
        self.tracker.force()
    }

    /// Size of the ac part (of the span, Q20), period (1/16 of a frame) and force (mN), while it oscillates.
    pub fn swing(&self, config: &HeadConfig) -> Option<(i32, u16, i32)> {
        let period_q4 = self.split.period_q4();
        let force_mn = self.force()?.mn();
        let span = i64::from(config.curve.bright_q4 - config.curve.dark_q4).max(1);
        let part = i64::from(self.split.envelope) * 16 * i64::from(ONE) / (span << Q);
        (period_q4 > 0).then_some((part.min(i64::from(ONE)) as i32, period_q4, force_mn))
    }

    pub fn rate_um_s(&self, config: &HeadConfig, fit: &RateFit) -> i32 {
        self.swing(config).map_or(0, |(part, period_q4, force_mn)| fit.rate_um_s(part, period_q4, force_mn))
    }

    /// Forces in place of a lost force sensor: Fn is the least that fits the light and the load the most. Shear
    /// is 0 and the ratio None.
    pub fn stand_in(&self) -> Option<Forces> {
        let Force { least_mn, most_mn } = self.force()?;
        Some(Forces { fn_mn: least_mn, fx_mn: 0, fy_mn: 0, ft_mn: 0, load_mn: most_mn, ratio_permille: None })
    }
}
