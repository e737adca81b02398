//! A self-test of named channels, and one in the terminal.

use anyhow::{Context, bail};
use tenax_frames::link::Client;
use tenax_hal_shim::channel::{CHANNELS, COUNT, Role, by_name};
use tenax_logic::setting::SettingId;

use super::Selftest;
use crate::guide::Say;

/// The channels of these names or prefixes; without any, all. Fails on a word that fits none.
pub fn named(words: &[String]) -> anyhow::Result<Vec<usize>> {
    let fits = |n: usize, word: &String| match by_name(word) {
        Some(only) => n == only,
        None => CHANNELS[n].name.starts_with(word.as_str()),
    };
    if let Some(word) = words.iter().find(|word| !(0..COUNT).any(|n| fits(n, word))) {
        bail!("no channel begins with `{word}`: `tenax tables wiring` has them");
    }
    Ok((0..COUNT).filter(|&n| words.is_empty() || words.iter().any(|word| fits(n, word))).collect())
}

impl Selftest {
    /// Of channels of these names or prefixes. Without any, a gripper without a wearer has no muscles to contract.
    /// Fails on a name that fits none.
    pub fn begin_named(words: &[String], head: bool, no_wearer: bool, limit_s: u32) -> anyhow::Result<Self> {
        let mut channels = named(words)?;
        if words.is_empty() && no_wearer {
            channels.retain(|&channel| Role::of(channel, head) != Role::Muscle);
        }
        Ok(Self::new(channels, head, limit_s))
    }
}

/// Runs the test to its end; whether all channels pass.
pub fn run(client: &mut Client, words: &[String], limit_s: u32, say: Say<'_>) -> anyhow::Result<bool> {
    let (head, no_wearer) =
        (client.setting(SettingId::Head)? != 0, client.setting(SettingId::NoWearer)? != 0);
    let mut test = Selftest::begin_named(words, head, no_wearer, limit_s)?;
    let mut printed = 0;
    loop {
        test.said[printed..].iter().try_for_each(|line| say(line))?;
        printed = test.said.len();
        if let Some(why) = &test.failed {
            bail!("{why}");
        }
        if test.is_over() {
            return Ok(test.passes());
        }
        client.keep_streaming(false)?;
        let message = client.next_message().context("the line ended")?;
        test.take(message.as_ref().map(|heard| &heard.received.message));
    }
}
