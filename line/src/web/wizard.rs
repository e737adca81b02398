//! The page's self-test: the terminal's, run beside the page's line. It only hears readings, so it needs no consent.

use anyhow::{Context, bail};
use tenax_logic::setting::SettingId;

use crate::guide::selftest::Session;
use crate::monitor::source::News;
use crate::monitor::view::View;

/// How long each touch is waited for, s: as `tenax selftest` does.
const WITHIN_S: u32 = 8;

/// The test that goes on or is over, if there is one.
#[derive(Default)]
pub struct Wizard {
    session: Option<Session>,
    failed: Option<String>,
    number: u64,
}

impl Wizard {
    pub const fn session(&self) -> Option<&Session> {
        self.session.as_ref()
    }

    /// Why it cannot go on.
    pub fn failed(&self) -> Option<&str> {
        self.failed.as_deref()
    }

    /// How many were begun so far.
    pub const fn number(&self) -> u64 {
        self.number
    }

    pub fn lines(&self) -> usize {
        self.session.as_ref().map_or(0, |session| session.said().len())
    }

    /// Does what the page asks for: `start`, with channels after it, `skip` or `stop`. Fails if that cannot be done now.
    pub fn command(&mut self, view: &View, words: &[String]) -> anyhow::Result<()> {
        match words.split_first() {
            Some((first, channels)) if first == "start" => {
                if let Some(gone) = &view.gone {
                    bail!("no line: {gone}");
                }
                let flag = |id| view.setting(id).context("the board has not said its settings yet");
                let (head, no_wearer) = (flag(SettingId::Head)? != 0, flag(SettingId::NoWearer)? != 0);
                self.session = Some(Session::begin(channels, head, no_wearer, WITHIN_S)?);
                self.failed = None;
                self.number += 1;
            }
            Some((first, [])) if first == "skip" && self.failed.is_none() => {
                self.session.as_mut().context("no test goes on")?.skip();
            }
            Some((first, [])) if first == "stop" => self.session = None,
            _ => bail!("write start, skip or stop"),
        }
        Ok(())
    }

    /// Hears what the line tells. A test without readings cannot go on.
    pub fn take(&mut self, news: &News) {
        let Some(session) = self.session.as_mut().filter(|_| self.failed.is_none()) else { return };
        let taken = match news {
            News::Frame(Ok(heard), ..) => session.take(Some(&heard.received.message)),
            News::Gone(why) if !session.test().is_over() => Err(anyhow::anyhow!("the line is gone: {why}")),
            _ => session.take(None),
        };
        self.failed = taken.err().map(|why| why.to_string());
    }
}
