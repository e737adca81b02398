//! What the wearer wants, and what somebody types.

use serde::Deserialize;
use tenax_hal_shim::behaviour::Behaviour;
use tenax_logic::setting::SettingId;
use toml::Spanned;

use crate::file::quantity::{Duration, Instant, Millivolts, Newtons};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Intent {
    Close,
    Open,
    Both,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Muscle {
    pub at_s: Instant,
    pub for_s: Duration,
    pub intent: Intent,
    pub level_mv: Millivolts,
    pub until_grip_n: Option<Newtons>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub enum CommandKind {
    Begin(Behaviour),
    End,
    Zero,
    Close,
    Open,
    Consent,
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

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Command {
    pub at_s: Instant,
    pub kind: Spanned<CommandKind>,
    pub value: Option<Spanned<i32>>,
    pub duty_permille: Option<Spanned<u16>>,
    pub for_s: Option<Duration>,
}
