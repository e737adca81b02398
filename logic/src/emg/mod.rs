//! EMG of the wearer's two muscles: [`Emg`] finds the wish ([`decide`]), whether it is a muscle's ([`proof`],
//! [`trust`]), and whether the calibration ([`calibration`], [`model`]) still fits ([`fit`]).

pub mod calibration;
pub mod constants;
pub mod decide;
pub mod fit;
pub mod fitted;
pub mod level;
pub mod mains;
pub mod model;
pub mod proof;
pub mod settings;
#[cfg(test)]
mod tests;
pub mod trust;

use tenax_hal_shim::front_end::MYO_REST_MV;

use self::decide::{Decide, Electrode, OVER_UV, Part, Wish};
use self::level::level_of;
use self::mains::{Mains, WINDOW};
use self::model::{EmgModel, Point};
use self::proof::Proof;
use self::trust::{Quality, Trust};

/// 14-bit sample to uV above the live zero; error at most 60 uV.
pub const fn uv_of_sample(sample: u16) -> i32 {
    // 3.3 V over 16380 steps is 201.465 uV; 12894 / 64 is 201.469.
    ((sample as i32 * 12_894) >> 6) - MYO_REST_MV as i32 * 1_000
}

const PAIRS: u8 = 3;

#[derive(Clone, Debug, Default)]
struct Channel {
    trust: Trust,
    active_uv: [i32; 2],
    sum_uv: i32,
    count: i32,
    over: bool,
    raised: bool,
    in_range: bool,
    /// It swings, and the other electrode does not.
    swings: bool,
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

    /// Level of the last reading: a mean would hide noise that is not a muscle's.
    fn level(&self) -> Option<i32> {
        if self.over { Some(const { level_of(OVER_UV) }) } else { self.trust.last_uv().map(level_of) }
    }

    /// Mean of the slow frame, uV.
    fn mean_uv(&self) -> Option<i32> {
        (self.count > 0).then(|| self.sum_uv / self.count.max(1))
    }

    fn end(&mut self, uv: Option<i32>, other_uv: i32) -> Electrode {
        let over = self.over;
        (self.sum_uv, self.count, self.over) = (0, 0, false);
        if let Some(uv) = uv {
            self.trust.judge(self.active_uv[0], uv, other_uv);
        }
        let trust = &self.trust;
        Electrode {
            uv,
            over,
            doubted: !trust.is_good(),
            still: trust.is_still(),
            hums: trust.hums(),
            lone: self.swings || trust.is_lone(),
        }
    }

    fn is_good(&self) -> bool {
        self.trust.is_good() && !self.swings
    }

    fn is_known(&self) -> bool {
        self.in_range && self.is_good()
    }

    fn is_active(&self) -> bool {
        self.raised && self.is_good()
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    pub wish: Wish,
    pub strength_permille: u16,
    /// An unproven contraction moves the hand slowly and little.
    pub proven: bool,
    /// The other electrode rose as the wish began: less than a proof, but more than a lifted electrode shows.
    pub heard: bool,
    /// Activity of any kind: the reflex is silent.
    pub active: bool,
    /// Both myosensors are healthy; if not, "not active" is not known.
    pub known: bool,
    /// One is healthy, and the other cannot be an active muscle.
    pub half_known: bool,
}

#[derive(Clone, Debug)]
pub struct Emg {
    decide: Decide,
    proof: Proof,
    channels: [Channel; 2],
    pairs: u8,
    electrodes: [Electrode; 2],
    /// The other electrode was doubted as active alone when the wish began.
    beside_lone: bool,
    verdict: Verdict,
}

impl Default for Emg {
    fn default() -> Self {
        Self::new(None)
    }
}

impl Emg {
    pub fn new(model: Option<&EmgModel>) -> Self {
        Self::of(Decide::new(model))
    }

    pub fn of(decide: Decide) -> Self {
        Self {
            channels: [0, 1].map(|n| Channel { active_uv: decide.active_uv(n), ..Channel::default() }),
            decide,
            proof: Proof::default(),
            pairs: 0,
            electrodes: Default::default(),
            beside_lone: false,
            verdict: Verdict::default(),
        }
    }

    pub fn calibrate(&mut self, model: Option<&EmgModel>) {
        self.decide = Decide::new(model);
        for (n, channel) in self.channels.iter_mut().enumerate() {
            channel.active_uv = self.decide.active_uv(n);
        }
        self.verdict = Verdict::default();
    }

    /// Readings above the live zero, uV, flexor first; None where a sensor gives no number.
    pub fn take(&mut self, uv: [Option<i32>; 2]) -> Verdict {
        self.read(0, uv[0]);
        self.read(1, uv[1]);
        self.verdict
    }

    /// One channel (0 flexor, others extensor), uV above the live zero; None counts as a gap. The extensor's
    /// third reading completes a slow frame.
    pub fn read(&mut self, channel: usize, uv: Option<i32>) {
        let n = channel.min(1);
        let channel = &mut self.channels[n];
        channel.read(uv);
        let good = channel.is_good();
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

    pub const fn is_whole(&self) -> bool {
        self.pairs == 0
    }

    #[inline(never)]
    fn decide(&mut self) {
        let levels = self.channels.each_ref().map(Channel::level);
        let uv = self.channels.each_ref().map(Channel::mean_uv);
        let [flexor, extensor] = &mut self.channels;
        let change_uv = |channel: &Channel, uv: Option<i32>| uv.map_or(0, |uv| channel.trust.change_uv(uv));
        let changes_uv = [change_uv(flexor, uv[0]), change_uv(extensor, uv[1])];
        let raised = [flexor.raised, extensor.raised];
        let [flexor_swings, extensor_swings] = self.proof.swing_alone(levels, raised, &self.decide);
        // What a doubted electrode does not hear may be a contraction.
        flexor.swings = flexor_swings && extensor.trust.is_good();
        extensor.swings = extensor_swings && flexor.trust.is_good();
        self.electrodes = [flexor.end(uv[0], changes_uv[1]), extensor.end(uv[1], changes_uv[0])];
        let wish = self.decide.take(&self.electrodes);
        let mover = self.decide.mover();
        let parts = self.decide.parts();
        let both_fall = parts != [Part::Rest; 2] && self.proof.both_fall(levels);
        for (site, part) in parts.into_iter().enumerate() {
            let n = self.decide.site_of(site);
            self.channels[n].trust.weigh(part, site == 0, wish == Wish::Rest || mover == n, both_fall);
        }
        let other = &self.electrodes[1 - mover];
        let [own_trust, other_trust] = [mover, 1 - mover].map(|n| &self.channels[n].trust);
        if wish != self.verdict.wish {
            self.beside_lone = other_trust.quality() == Quality::Endless && own_trust.is_fresh();
        }
        // A deaf electrode can prove nothing, and disprove nothing.
        let lone = self.beside_lone && other.lone;
        let is_out = other_trust.last_uv().is_none() || other_trust.quality() == Quality::Saturated;
        let deaf = is_out || other.hums || lone;
        let hears = self.decide.hears().filter(|_| !deaf);
        let proven = self.proof.take(levels, wish, mover, own_trust, hears, raised[mover])
            && !self.channels[mover].swings
            && !(lone && wish == Wish::Open && !self.decide.outweighs());
        let [flexor, extensor] = &self.channels;
        self.verdict = Verdict {
            wish,
            strength_permille: self.decide.strength_permille(),
            proven,
            heard: wish != Wish::Rest && self.proof.at_once,
            active: flexor.is_active() || extensor.is_active() || wish != Wish::Rest,
            known: flexor.is_known() && extensor.is_known(),
            half_known: false,
        };
    }

    /// Levels of the last 0.1 s, flexor first.
    pub fn levels(&self) -> Point {
        self.proof.levels()
    }

    pub fn is_known(&self, channel: usize) -> bool {
        self.channels[channel.min(1)].is_known()
    }

    /// The reading, uV, is below activity or where the envelope has stood still: no muscle at work.
    pub fn is_idle(&self, channel: usize, uv: i32) -> bool {
        let channel = &self.channels[channel.min(1)];
        uv < channel.active_uv[1] || channel.trust.hums_at(uv)
    }

    pub const fn verdict(&self) -> Verdict {
        self.verdict
    }

    pub const fn electrodes(&self) -> [Electrode; 2] {
        self.electrodes
    }

    pub fn is_active(&self, channel: usize) -> bool {
        self.channels[channel.min(1)].is_active()
    }

    /// Above the threshold of activity, with hysteresis, even if the electrode is doubted.
    pub fn is_raised(&self, channel: usize) -> bool {
        self.channels[channel.min(1)].raised
    }

    pub fn quality(&self, channel: usize) -> Quality {
        let channel = &self.channels[channel.min(1)];
        if channel.trust.is_good() && channel.swings { Quality::LeadOff } else { channel.trust.quality() }
    }

    /// 64 readings, one a slow frame, the oldest first, 128 uV a unit; None until full.
    pub fn window(&self, channel: usize) -> Option<&[i16; WINDOW]> {
        self.channels[channel.min(1)].trust.window()
    }

    pub fn hear(&mut self, channel: usize, mains: Mains) {
        let channel = if channel == 0 { 0 } else { 1 };
        self.channels[channel].trust.hear(mains);
    }
}
