//! A channel called by its name.

use serde::Deserialize;
use tenax_hal_shim::channel::{CHANNELS, by_name};

use super::near;

/// Index of a channel in the channel map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct ChannelName(usize);

#[derive(Debug, thiserror::Error)]
#[error("no channel is called `{name}`; near it: {near}")]
pub struct NoSuchChannel {
    name: String,
    near: String,
}

impl ChannelName {
    /// Index in [`CHANNELS`].
    pub const fn index(self) -> usize {
        self.0
    }

    pub const fn name(self) -> &'static str {
        CHANNELS[self.0].name
    }
}

impl TryFrom<String> for ChannelName {
    type Error = NoSuchChannel;

    fn try_from(name: String) -> Result<Self, NoSuchChannel> {
        by_name(&name).map(Self).ok_or_else(|| {
            let near = near(&name, CHANNELS.iter().map(|channel| channel.name));
            NoSuchChannel { near, name }
        })
    }
}
