//! Calibrations that tell a person step by step what to do at the hand. The board's readings say when a step is done.

pub mod emg;
pub mod force;
pub mod friction;
pub mod selftest;

use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use tenax_frames::link::{ANSWER_WITHIN, Client};
use tenax_frames::words::refusal_words;
use tenax_hal_shim::wire::{Answer, Down, Forces, Up};

pub type Say<'a> = &'a mut dyn FnMut(&str) -> anyhow::Result<()>;

fn ask(client: &mut Client, command: Down) -> anyhow::Result<()> {
    match client.ask(&command, ANSWER_WITHIN)? {
        Answer::Done => Ok(()),
        Answer::Refused(why) => bail!("the board refuses {command:?}: {}", refusal_words(&why)),
        other => bail!("the board answers {other:?}"),
    }
}

fn wait_for<T>(
    client: &mut Client,
    within: Duration,
    what: &str,
    mut found: impl FnMut(&Up) -> anyhow::Result<Option<T>>,
) -> anyhow::Result<T> {
    let began = Instant::now();
    while began.elapsed() < within {
        let heard = client.next_message().context("the line ended")?;
        if let Some(heard) = heard
            && let Some(found) = found(&heard.received.message)?
        {
            return Ok(found);
        }
    }
    bail!("waited {} s for {what}, in vain", within.as_secs())
}

fn forces(message: &Up) -> Option<Forces> {
    match message {
        Up::Slow(slow) => slow.forces,
        _ => None,
    }
}
