//! EMG of the wearer's two muscles: calibrated to a wearer, classified, and its quality judged.
//!
//! The myosensors give smoothed envelopes, each read three times a slow frame. [`log2`] turns them into levels;
//! [`calibration`] learns where rest, closing and opening lie and [`model`] keeps it; [`quality`] says whether an
//! envelope is a muscle's, with the help of a spectrum outside the tick ([`mains`]); [`intent`] says what the wearer
//! wants. [`Emg`] is the whole. `docs/emg.md` has what was measured.

pub mod calibration;
pub mod intent;
pub mod log2;
pub mod mains;
pub mod model;
pub mod quality;
pub mod settings;

#[cfg(test)]
mod tests;

use tenax_hal_shim::front_end::MYO_REST_MV;

use self::intent::{Electrode, Intent, Wish};
use self::log2::level_of;
use self::mains::{Mains, WINDOW};
use self::model::EmgModel;
use self::quality::{Expected, Quality, Watch};

/// A reading above the live zero, uV, from its sample (14 bits): at most 60 uV from the true one.
#[must_use]
pub const fn uv_of_sample(sample: u16) -> i32 {
    // 3.3 V over 16380 steps is 201.465 uV; 12894 / 64 is 201.469.
    ((sample as i32 * 12_894) >> 6) - MYO_REST_MV as i32 * 1_000
}

/// What the muscles say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    /// What the wearer wants of the hand.
    pub wish: Wish,
    /// How strongly, per mille: for the speed. 0 at rest.
    pub strength_permille: u16,
    /// Whether a muscle is active, whatever it wants: the reflex is silent.
    pub active: bool,
    /// Whether both sensors can be believed: if not, "not active" is not known.
    pub known: bool,
}

/// Both electrodes and what they mean.
#[derive(Clone, Debug)]
pub struct Emg {
    intent: Intent,
    expected: [Expected; 2],
    watches: [Watch; 2],
    active: [bool; 2],
    electrodes: [Electrode; 2],
    verdict: Verdict,
}

impl Default for Emg {
    /// Nobody is calibrated.
    fn default() -> Self {
        Self::new(None)
    }
}

impl Emg {
    /// For a wearer; without one only what cannot be mistaken moves the hand.
    #[must_use]
    pub fn new(model: Option<&EmgModel>) -> Self {
        let intent = Intent::new(model);
        Self {
            expected: intent.expected(),
            intent,
            watches: Default::default(),
            active: [false; 2],
            electrodes: Default::default(),
            verdict: Verdict::default(),
        }
    }

    /// From now on for this wearer. The hand rests first; what is known of the sensors stays.
    pub fn calibrate(&mut self, model: Option<&EmgModel>) {
        self.intent = Intent::new(model);
        self.expected = self.intent.expected();
        self.verdict = Verdict::default();
    }

    /// Takes a pair of readings above the live zero, uV, flexor first; none where a sensor gives no number.
    pub fn take(&mut self, uv: [Option<i32>; 2]) -> Verdict {
        self.read(0, uv[0]);
        self.read(1, uv[1]);
        self.verdict
    }

    /// Takes one channel's reading, as they come: 0 the flexor's, others the extensor's, with which the pair is complete
    /// and decided on. A reading that was missed is to be told too, as none.
    pub fn read(&mut self, channel: usize, uv: Option<i32>) {
        let n = channel.min(1);
        self.watches[n].take(&self.expected[n], uv);
        let good = self.watches[n].is_good();
        let level = uv.map(level_of).filter(|_| good);
        let Expected { active, inactive, .. } = self.expected[n];
        let threshold = if self.active[n] { inactive } else { active };
        self.active[n] = level.is_some_and(|level| level >= threshold);
        self.electrodes[n] = Electrode {
            level,
            proven: self.watches[n].is_proven(),
            clipped: self.watches[n].is_clipped(),
            turned: self.watches[n].has_turned(),
            unmodulated: self.watches[n].is_unmodulated(),
        };
        // Silence does not wait for the other half of the pair.
        self.verdict.active |= self.active[n];
        self.verdict.known &= level.is_some();
        if n == 1 {
            self.decide();
        }
    }

    fn decide(&mut self) {
        let wish = self.intent.take(&self.electrodes);
        self.verdict = Verdict {
            wish,
            strength_permille: if wish == Wish::Rest { 0 } else { self.intent.strength_permille() },
            active: self.active[0] || self.active[1] || wish != Wish::Rest,
            known: self.electrodes.iter().all(|electrode| electrode.level.is_some()),
        };
    }

    /// The last verdict.
    #[must_use]
    pub const fn verdict(&self) -> Verdict {
        self.verdict
    }

    /// Whether a channel is active: 0 the flexor's, others the extensor's.
    #[must_use]
    pub fn is_active(&self, channel: usize) -> bool {
        self.active[channel.min(1)]
    }

    /// What a channel's envelope is: 0 the flexor's, others the extensor's.
    #[must_use]
    pub fn quality(&self, channel: usize) -> Quality {
        self.watches[channel.min(1)].quality()
    }

    /// A full window of a channel, for [`mains::mains_of`] outside the tick.
    #[must_use]
    pub fn window(&self, channel: usize) -> Option<&[i16; WINDOW]> {
        self.watches[channel.min(1)].window()
    }

    /// Takes what the window said, and begins the next one.
    pub const fn hear(&mut self, channel: usize, mains: Mains) {
        let channel = if channel == 0 { 0 } else { 1 };
        self.watches[channel].hear(mains);
    }
}
