//! Another hand at the object.

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{Duration, Instant, Milliseconds, Pulling};

/// Somebody pulls at the object, or pushes it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pull {
    pub at_s: Spanned<Instant>,
    pub for_s: Duration,
    /// How hard: upwards; negative is down.
    pub force_n: Pulling,
    /// How long it takes to come and to go.
    pub ramp_ms: Milliseconds,
    /// They take the object over: once the fingers let go of it, it is theirs, and not dropped.
    #[serde(default)]
    pub takes: bool,
}
