//! Every number that can be chosen. Plain values, apart from all state, so that a whole set can be swapped at once.

use crate::behaviours::BehaviourConfig;
use crate::hebbian::{LearningConfig, Rule, TeacherConfig};
use crate::photoelastic::HeadConfig;
use tenax_hal_shim::setting::SettingId;

/// Frames in this many milliseconds.
#[must_use]
pub const fn frames(ms: u32) -> u32 {
    ms * tenax_hal_shim::channel::FRAME_HZ / 1_000
}

/// Thresholds of the vibration detector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VibrationConfig {
    /// S1: envelope that means slip, in samples (14 bits).
    pub s1: u16,
    /// Envelope above the slip band that a knock has at least, in samples (14 bits).
    pub knock_level: u16,
    /// A vibration whose envelope above the slip band is more than this part of the one inside it, per mille, is a
    /// knock. On real recordings slip onsets stay below 300, a shaken rig reaches 2500.
    pub knock_permille: u16,
    /// A knock is over after this long, in frames; what lasts longer is slip whatever it sounds like.
    pub knock_frames: u32,
    /// Whether the mains is at 60 Hz, not 50.
    pub mains_60_hz: bool,
}

/// Thresholds of the friction detector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrictionConfig {
    /// S2: Ft/Fn that means incipient slip, per mille, until a stroke has measured it.
    pub s2_permille: u16,
    /// The part of a measured mu_s that becomes S2, per mille.
    pub s2_of_mu_s_permille: u16,
    /// Fn from which the finger counts as loaded, mN: below, noise divided by a small Fn would be a large ratio.
    pub loaded_mn: i32,
}

/// What the network's output means, and how it learns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TouchConfig {
    /// How far below 0 the films' part of o1 means slip, per mille.
    pub slip_permille: u16,
    /// For how long, in frames, if only some films hear it: slip begins somewhere.
    pub slip_frames: u32,
    /// For how long if all of them hear it, in frames: longer than a knock.
    pub everywhere_frames: u32,
    /// How long after a knock or a run of the motor it means nothing, in frames: what the envelopes still have of it, and
    /// the motor's dead time.
    pub loud_frames: u32,
    /// How far ahead rising shear is looked at, ms; 0: it never warns.
    pub ahead_ms: u16,
    /// From this duty on the motor runs fast, per mille. Closing more slowly is a way to take something, and to learn.
    pub loud_duty_permille: u16,
    /// When a teacher is believed.
    pub teacher: TeacherConfig,
    /// How fast it is learned from.
    pub learning: LearningConfig,
    /// The same in the formats of the update.
    pub rule: Rule,
}

/// Thresholds of the myoelectric gate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GateConfig {
    /// Envelope above rest that both muscles have to reach to consent, mV.
    pub on_mv: u16,
    /// How long a muscle counts as active after its last activity, in frames: the pause between two contractions is
    /// not an invitation to the reflex.
    pub hold_frames: u32,
    /// Duty asked for by the weakest contraction that moves the hand, per mille.
    pub slowest_permille: u16,
}

/// Limits and pulses of the grip reflex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GripConfig {
    /// Duty of the pulse that answers slip, per mille.
    pub slip_duty_permille: u16,
    /// Its length, in frames.
    pub slip_frames: u32,
    /// Its length at most while a detector still says slip, in frames.
    pub slip_frames_max: u32,
    /// Duty of the pulse that answers incipient slip, per mille.
    pub incipient_duty_permille: u16,
    /// Its length, in frames.
    pub incipient_frames: u32,
    /// How long the object is given to settle after a pulse, in frames: longer than the motor's dead time, so that the
    /// noise of the hand's own closing is not answered by more closing.
    pub settle_frames: u32,
    /// Fn above which the reflex closes no further, mN.
    pub ceiling_mn: i32,
    /// How long the reflex may close altogether while no force is known, in frames, until the wearer takes over once.
    pub blind_frames: u32,
}

/// All of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// S1.
    pub vibration: VibrationConfig,
    /// S2.
    pub friction: FrictionConfig,
    /// The network.
    pub touch: TouchConfig,
    /// The wearer's muscles.
    pub gate: GateConfig,
    /// The reflex.
    pub grip: GripConfig,
    /// What is above it.
    pub behaviour: BehaviourConfig,
    /// The photoelastic head.
    pub head: HeadConfig,
    /// The serial line needs no consent.
    pub line_trusted: bool,
    /// Frames are streamed from the start on.
    pub stream_at_start: bool,
    /// There is no wearer: a myosensor that gives no number is not missed.
    pub no_wearer: bool,
}

impl Config {
    /// Numbers without a meaning yet: [`default`](Self::default) sets every one of them from its row.
    const BLANK: Self = Self {
        vibration: VibrationConfig {
            s1: 0,
            knock_level: 0,
            knock_permille: 0,
            knock_frames: 0,
            mains_60_hz: false,
        },
        friction: FrictionConfig { s2_permille: 0, s2_of_mu_s_permille: 0, loaded_mn: 0 },
        touch: TouchConfig {
            slip_permille: 0,
            slip_frames: 0,
            everywhere_frames: 0,
            loud_frames: 0,
            loud_duty_permille: 0,
            ahead_ms: 0,
            teacher: TeacherConfig { fresh_ms: 0 },
            learning: LearningConfig::DEFAULT,
            rule: Rule::DEFAULT,
        },
        gate: GateConfig { on_mv: 0, hold_frames: 0, slowest_permille: 0 },
        grip: GripConfig {
            slip_duty_permille: 0,
            slip_frames: 0,
            slip_frames_max: 0,
            incipient_duty_permille: 0,
            incipient_frames: 0,
            settle_frames: 0,
            ceiling_mn: 0,
            blind_frames: 0,
        },
        behaviour: BehaviourConfig {
            duty_permille: 0,
            movement_frames: 0,
            wait_frames: 0,
            gentle_score: 0,
            changed_cells: 0,
            moving_e4: 0,
            turn_lead_frames: 0,
        },
        head: HeadConfig::BLANK,
        line_trusted: false,
        stream_at_start: false,
        no_wearer: false,
    };
}

impl Default for Config {
    fn default() -> Self {
        let mut config = Self::BLANK;
        for id in SettingId::ALL {
            config.put(id, id.row().default);
        }
        config
    }
}
