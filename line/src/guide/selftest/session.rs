//! A self-test on a line, the same for the terminal and the page.

use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use tenax_frames::link::Client;
use tenax_hal_shim::channel::{CHANNELS, COUNT, Role, by_name};
use tenax_hal_shim::wire::Up;
use tenax_logic::setting::SettingId;

use super::{REST_PROMPT, Selftest};
use crate::guide::Say;

/// A board that is silent for longer sends no readings.
const SILENCE: Duration = Duration::from_secs(4);

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

/// A self-test and all its lines.
pub struct Session {
    test: Selftest,
    said: Vec<String>,
    heard: Instant,
    failed: Option<String>,
}

impl Session {
    /// Of channels of these names or prefixes. Without any, a gripper without a wearer has no muscles to contract.
    /// Fails on a name that fits none.
    pub fn begin(words: &[String], head: bool, no_wearer: bool, limit_s: u32) -> anyhow::Result<Self> {
        let mut channels = named(words)?;
        if words.is_empty() && no_wearer {
            channels.retain(|&channel| Role::of(channel, head) != Role::Muscle);
        }
        let said = ["The hand is empty: the reflex may close it on what is pressed.", REST_PROMPT];
        Ok(Self {
            test: Selftest::new(channels, head, limit_s),
            said: said.map(str::to_owned).to_vec(),
            heard: Instant::now(),
            failed: None,
        })
    }

    pub const fn test(&self) -> &Selftest {
        &self.test
    }

    /// Every line so far, the oldest first.
    pub fn said(&self) -> &[String] {
        &self.said
    }

    /// Why the test cannot go on.
    pub fn failed(&self) -> Option<&str> {
        self.failed.as_deref()
    }

    /// Ends the test, unless it is over.
    pub fn fail(&mut self, why: &str) {
        if !self.test.is_over() {
            self.failed.get_or_insert_with(|| why.to_owned());
        }
    }

    /// Takes a message, or notes that none came. A board that sends no readings or starts anew fails the test.
    pub fn take(&mut self, message: Option<&Up>) {
        match message {
            _ if self.test.is_over() || self.failed.is_some() => {}
            Some(Up::Senses(senses)) => {
                self.heard = Instant::now();
                let said = self.test.hear(senses);
                self.said.extend(said);
            }
            Some(Up::Hello { .. }) if self.test.has_begun() => {
                self.fail("the board was switched on anew: start again");
            }
            _ if self.heard.elapsed() > SILENCE => self.fail("the board sends no readings"),
            _ => {}
        }
    }

    /// Leaves out the channel that is asked for.
    pub fn skip(&mut self) {
        if self.failed.is_none() {
            let said = self.test.skip();
            self.said.extend(said);
        }
    }
}

/// Runs the test to its end; whether all channels pass.
pub fn run(client: &mut Client, words: &[String], limit_s: u32, say: Say<'_>) -> anyhow::Result<bool> {
    let (head, no_wearer) =
        (client.setting(SettingId::Head)? != 0, client.setting(SettingId::NoWearer)? != 0);
    let mut session = Session::begin(words, head, no_wearer, limit_s)?;
    let mut printed = 0;
    loop {
        session.said()[printed..].iter().try_for_each(|line| say(line))?;
        printed = session.said().len();
        if let Some(why) = session.failed() {
            bail!("{why}");
        }
        if session.test().is_over() {
            return Ok(session.test().passes());
        }
        client.keep_streaming(false)?;
        let message = client.next_message().context("the line ended")?;
        session.take(message.as_ref().map(|heard| &heard.received.message));
    }
}
