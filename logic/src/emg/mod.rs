//! EMG of the wearer's two muscles: calibrated to a wearer, classified, and its quality judged.
//!
//! The myosensors give smoothed envelopes, each read three times a slow frame. [`level`] turns them into logarithms;
//! [`calibration`] learns where rest, closing and opening lie and [`model`] keeps it; [`decide`] says what the wearer wants,
//! with the constants of [`fitted`]; [`trust`] says whether an envelope is a muscle's, with the help of a spectrum outside the
//! tick ([`mains`]); [`fit`] whether the calibration still fits. [`Emg`] is the whole. `docs/emg.md` has what was measured.

pub mod calibration;
pub mod constants;
pub mod decide;
pub mod fit;
pub mod fitted;
pub mod level;
pub mod log2;
pub mod mains;
pub mod model;
pub mod proof;
pub mod settings;
pub mod trust;

#[cfg(test)]
mod tests;

use tenax_hal_shim::front_end::MYO_REST_MV;

use self::decide::{Decide, Electrode, OVER_UV, Wish};
use self::level::level_of;
use self::mains::{Mains, WINDOW};
use self::model::{EmgModel, Point};
use self::proof::Proof;
use self::trust::{Quality, Trust};

/// A reading above the live zero, uV, from its sample (14 bits): at most 60 uV from the true one.
#[must_use]
pub const fn uv_of_sample(sample: u16) -> i32 {
    // 3.3 V over 16380 steps is 201.465 uV; 12894 / 64 is 201.469.
    ((sample as i32 * 12_894) >> 6) - MYO_REST_MV as i32 * 1_000
}

/// Pairs of readings in a slow frame.
const PAIRS: u8 = 3;

/// What is known of an electrode.
#[derive(Clone, Debug, Default)]
struct Channel {
    trust: Trust,
    /// Envelopes from which the muscle is active, and below which it is no more, uV.
    active_uv: [i32; 2],
    /// Sum of the numbers of this slow frame, how many they are, and whether one was above [`OVER_UV`].
    sum_uv: i32,
    count: i32,
    over: bool,
    raised: bool,
    /// Whether the last reading was in range.
    in_range: bool,
}

impl Channel {
    fn read(&mut self, uv: Option<i32>) {
        let in_range = uv.filter(|&uv| uv < OVER_UV);
        let bridged = self.trust.take(in_range);
        if let Some(uv) = uv.or(bridged) {
            self.sum_uv += uv.min(OVER_UV);
            self.count += 1;
        }
        if uv.is_some() && in_range.is_none() {
            self.over = true;
        } else {
            self.raised = bridged.is_some_and(|uv| uv >= self.active_uv[usize::from(self.raised)]);
        }
        self.in_range = in_range.is_some();
    }

    /// The level of the last reading: what a mean of them would hide of noise is not a muscle's.
    fn level(&self) -> Option<i32> {
        if self.over { Some(const { level_of(OVER_UV) }) } else { self.trust.last_uv().map(level_of) }
    }

    /// The slow frame that has ended.
    fn end(&mut self) -> Electrode {
        let uv = (self.count > 0).then(|| self.sum_uv / self.count.max(1));
        let over = self.over;
        (self.sum_uv, self.count, self.over) = (0, 0, false);
        if let Some(uv) = uv {
            self.trust.judge(self.active_uv[0], uv);
        }
        let trust = &self.trust;
        Electrode { uv, over, doubted: !trust.is_good(), still: trust.is_still(), hums: trust.hums() }
    }

    fn is_known(&self) -> bool {
        self.in_range && self.trust.is_good()
    }

    fn is_active(&self) -> bool {
        self.raised && self.trust.is_good()
    }
}

/// The wearer's wish and activity, from both muscles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    /// The wearer's wish.
    pub wish: Wish,
    /// Strength of the wish, 0 to 1000 per mille: for the speed. 0 at rest.
    pub strength_permille: u16,
    /// Whether the contraction is proven to be a muscle's: an unproven one moves the hand slowly and little.
    pub proven: bool,
    /// Whether a muscle is active, whatever it wants: the reflex is silent.
    pub active: bool,
    /// Whether both myosensors are healthy: if not, "not active" is not known.
    pub known: bool,
    /// Whether one is healthy, and the other, if doubted, cannot be an active muscle. Set by [`Muscles`](crate::muscles::Muscles).
    pub half_known: bool,
}

/// Levels and health of both electrodes, and the wish that follows.
#[derive(Clone, Debug)]
pub struct Emg {
    decide: Decide,
    proof: Proof,
    channels: [Channel; 2],
    /// Pairs of this slow frame.
    pairs: u8,
    /// Whether each electrode swings while the other one does not: reported, and no proof.
    lone: [bool; 2],
    electrodes: [Electrode; 2],
    verdict: Verdict,
}

impl Default for Emg {
    /// Without calibration.
    fn default() -> Self {
        Self::new(None)
    }
}

impl Emg {
    /// Recognition for a calibrated wearer; None: only very clear contractions move the hand.
    pub fn new(model: Option<&EmgModel>) -> Self {
        Self::of(Decide::new(model))
    }

    /// Recognition with another decision, to fit its constants.
    pub fn of(decide: Decide) -> Self {
        Self {
            channels: [0, 1].map(|n| Channel { active_uv: decide.active_uv(n), ..Channel::default() }),
            decide,
            proof: Proof::default(),
            pairs: 0,
            lone: [false; 2],
            electrodes: Default::default(),
            verdict: Verdict::default(),
        }
    }

    /// Changes the calibration. The wish begins at rest; the sensors' state stays.
    pub fn calibrate(&mut self, model: Option<&EmgModel>) {
        self.decide = Decide::new(model);
        for (n, channel) in self.channels.iter_mut().enumerate() {
            channel.active_uv = self.decide.active_uv(n);
        }
        self.verdict = Verdict::default();
    }

    /// Takes a pair of readings above the live zero, uV, flexor first; none where a sensor gives no number.
    pub fn take(&mut self, uv: [Option<i32>; 2]) -> Verdict {
        self.read(0, uv[0]);
        self.read(1, uv[1]);
        self.verdict
    }

    /// Takes the reading of one channel above the live zero, uV: channel 0 is the flexor, others the extensor. Pass
    /// None for a missing reading too: gaps are counted. The extensor's third reading completes a slow frame and updates the
    /// verdict; activity and doubt are in it at once.
    pub fn read(&mut self, channel: usize, uv: Option<i32>) {
        let n = channel.min(1);
        let channel = &mut self.channels[n];
        channel.read(uv);
        let good = channel.trust.is_good();
        self.verdict.active |= good & channel.raised;
        self.verdict.known &= good & channel.in_range;
        if n == 1 {
            self.pairs += 1;
            if self.pairs >= PAIRS {
                self.pairs = 0;
                self.decide();
            }
        }
    }

    /// Whether the last pair completed a slow frame.
    pub const fn is_whole(&self) -> bool {
        self.pairs == 0
    }

    #[inline(never)]
    fn decide(&mut self) {
        let levels = self.channels.each_ref().map(Channel::level);
        let [flexor, extensor] = &mut self.channels;
        self.electrodes = [flexor.end(), extensor.end()];
        let wish = self.decide.take(&self.electrodes);
        let mover = self.decide.mover();
        let raised = self.channels.each_ref().map(|channel| channel.raised);
        self.lone = self.proof.lone(levels, raised);
        let (trust, hears) = (&self.channels[mover].trust, self.decide.hears());
        let proven = self.proof.take(levels, wish, mover, trust, hears, raised[mover]) && !self.lone[mover];
        let [flexor, extensor] = &self.channels;
        self.verdict = Verdict {
            wish,
            strength_permille: self.decide.strength_permille(),
            proven,
            active: flexor.is_active() || extensor.is_active() || wish != Wish::Rest,
            known: flexor.is_known() && extensor.is_known(),
            half_known: false,
        };
    }

    /// The level of each electrode of the last 0.1 s, flexor first.
    pub fn levels(&self) -> Point {
        self.proof.levels()
    }

    /// Whether the last reading of channel 0 (flexor) or another (extensor) was in range and its electrode is not
    /// doubted.
    #[must_use]
    pub fn is_known(&self, channel: usize) -> bool {
        self.channels[channel.min(1)].is_known()
    }

    /// Whether a reading of a channel, uV, can be no muscle's at work: it is below activity, or stands where it has stood still.
    #[must_use]
    pub fn is_idle(&self, channel: usize, uv: i32) -> bool {
        let channel = &self.channels[channel.min(1)];
        uv < channel.active_uv[1] || channel.trust.hums_at(uv)
    }

    /// The last verdict.
    pub const fn verdict(&self) -> Verdict {
        self.verdict
    }

    /// Both electrodes as they were decided on, flexor first: for who fits what follows from them.
    pub const fn electrodes(&self) -> [Electrode; 2] {
        self.electrodes
    }

    /// Whether channel 0 (flexor) or another (extensor) is active: its level is above the threshold of activity, and
    /// its electrode is not doubted.
    #[must_use]
    pub fn is_active(&self, channel: usize) -> bool {
        self.channels[channel.min(1)].is_active()
    }

    /// Whether the level of channel 0 (flexor) or another (extensor) is above its threshold of activity, with
    /// hysteresis, even if the electrode is doubted.
    #[must_use]
    pub fn is_raised(&self, channel: usize) -> bool {
        self.channels[channel.min(1)].raised
    }

    /// Returns the quality of an envelope: channel 0 is the flexor, others the extensor.
    #[must_use]
    pub fn quality(&self, channel: usize) -> Quality {
        match self.channels[channel.min(1)].trust.quality() {
            Quality::Good if self.lone[channel.min(1)] => Quality::LeadOff,
            quality => quality,
        }
    }

    /// Returns the window of channel 0 (flexor) or another (extensor), the input of [`mains::mains_of`] outside the
    /// tick: 64 readings, one a slow frame, the oldest first, 128 uV a unit. None until it is full.
    #[must_use]
    pub fn window(&self, channel: usize) -> Option<&[i16; WINDOW]> {
        self.channels[channel.min(1)].trust.window()
    }

    /// Takes the result of a channel's window ([`mains::mains_of`]), and begins the next window. Channel 0 is the
    /// flexor.
    pub const fn hear(&mut self, channel: usize, mains: Mains) {
        let channel = if channel == 0 { 0 } else { 1 };
        self.channels[channel].trust.hear(mains);
    }
}
