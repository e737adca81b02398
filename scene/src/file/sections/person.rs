//! What the wearer wants, and what somebody types.

use serde::Deserialize;
use tenax_hal_shim::behaviour::Behaviour;
use tenax_logic::setting::SettingId;
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

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Muscle {
    pub at_s: Spanned<Instant>,
    /// How long at most.
    pub for_s: Duration,
    pub intent: Intent,
    /// How strongly: envelope above rest.
    pub level_mv: Millivolts,
    /// They let go as soon as each finger presses this much.
    pub until_grip_n: Option<Newtons>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub enum CommandKind {
    /// A behaviour begins; a turn is by `value` degrees.
    Begin(Behaviour),
    End,
    Zero,
    /// The hand is closed with `duty_permille` for `for_s`.
    Close,
    Open,
    /// Somebody at the hand presses the board's button: consent to what the line sends.
    Consent,
    /// A setting is set to `value`, in its unit: `set-` and the setting's name.
    Set(SettingId),
}

impl TryFrom<String> for CommandKind {
    type Error = String;

    fn try_from(kind: String) -> Result<Self, String> {
        let setting = || {
            let name = kind.strip_prefix("set-")?;
            SettingId::by_name(name).map(Self::Set)
        };
        Ok(match kind.as_str() {
            "stroke-begin" => Self::Begin(Behaviour::Stroke),
            "grasp-gently" => Self::Begin(Behaviour::GentleGrasp),
            "hold" => Self::Begin(Behaviour::Hold),
            "hand-over" => Self::Begin(Behaviour::HandOver),
            "turn" => Self::Begin(Behaviour::Turn { by_ddeg: 0 }),
            "stroke-end" | "end" => Self::End,
            "zero" => Self::Zero,
            "close" => Self::Close,
            "open" => Self::Open,
            "consent" => Self::Consent,
            _ => setting().ok_or_else(|| {
                let settings = SettingId::ALL.map(|id| format!("set-{}", id.row().name)).join(", ");
                format!(
                    "kind = \"{kind}\" is no command; allowed: stroke-begin, stroke-end, grasp-gently, hold, \
                     hand-over, turn, end, zero, close, open, consent, {settings}"
                )
            })?,
        })
    }
}

/// A command over the serial line.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Command {
    pub at_s: Spanned<Instant>,
    pub kind: Spanned<CommandKind>,
    /// Of a setting, in the unit that the kind names.
    pub value: Option<Spanned<i32>>,
    /// Of a drive.
    pub duty_permille: Option<Spanned<u16>>,
    /// Of a drive: how long the key is held.
    pub for_s: Option<Duration>,
}
