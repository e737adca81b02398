//! Another hand at the object.

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{Duration, Instant, Milliseconds, Pulling};

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pull {
    pub at_s: Spanned<Instant>,
    pub for_s: Duration,
    pub force_n: Pulling,
    pub ramp_ms: Milliseconds,
    #[serde(default)]
    pub takes: bool,
}
