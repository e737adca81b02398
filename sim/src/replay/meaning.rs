//! What a movement means for the hand, by the recording's name: what a replay is held against.

use serde::{Deserialize, Serialize};
use toml::Spanned;

use super::recipe;

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Motion {
    Rest,
    Close,
    Open,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Meaning {
    /// Names of the recordings; `*` and `?` match as in a shell. The first row that matches counts.
    pub named: Spanned<String>,
    pub wants: Motion,
    pub never: Vec<Motion>,
}

impl Meaning {
    pub fn is_for(&self, file_name: &str) -> bool {
        recipe::matches([&self.named], file_name)
    }
}
