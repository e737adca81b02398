//! What the wearer wants, and what somebody types.

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{Duration, Instant, Millivolts, Newtons};

/// What the wearer wants of the hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Intent {
    /// Flexor.
    Close,
    /// Extensor.
    Open,
    /// Both at once: co-contraction.
    Both,
}

/// The wearer contracts.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Muscle {
    /// When.
    pub at_s: Spanned<Instant>,
    /// How long at most.
    pub for_s: Duration,
    /// What for.
    pub intent: Intent,
    /// How strongly: envelope above rest.
    pub level_mv: Millivolts,
    /// They let go as soon as each finger presses this much.
    pub until_grip_n: Option<Newtons>,
}

/// What somebody types.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CommandKind {
    /// A stroke begins.
    StrokeBegin,
    /// A stroke ends.
    StrokeEnd,
    /// The force sensor is zeroed.
    Zero,
    /// The hand is closed with `duty_permille` for `for_s`.
    Close,
    /// The hand is opened, likewise.
    Open,
    /// S1 is set to `value`, mV.
    SetS1Mv,
    /// S2 is set to `value`, per mille.
    SetS2Permille,
    /// The threshold of the myosensors is set to `value`, mV.
    SetMyoOnMv,
    /// The force ceiling is set to `value`, mN.
    SetForceCeilingMn,
    /// How far below 0 the network's o1 means slip is set to `value`, per mille.
    SetNetworkSlipPermille,
}

/// A command over the serial line.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Command {
    /// When.
    pub at_s: Spanned<Instant>,
    /// What.
    pub kind: Spanned<CommandKind>,
    /// Of a setting, in the unit that the kind names.
    pub value: Option<Spanned<u32>>,
    /// Of a drive.
    pub duty_permille: Option<Spanned<u16>>,
    /// Of a drive: how long the key is held.
    pub for_s: Option<Duration>,
}
