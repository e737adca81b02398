//! Calibrations in which a person does something at the hand and is told what, step by step.
//!
//! Nobody has to press a key: the board's own readings say when a weight is on, a stroke is over, a muscle is relaxed.

pub mod emg;
pub mod force;
pub mod friction;
pub mod selftest;

use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use tenax_hal_shim::wire::{Answer, Down, Forces, Refusal, Up};

use tenax_frames::link::{ANSWER_WITHIN, Client};

/// Where the person reads what to do.
pub type Say<'a> = &'a mut dyn FnMut(&str) -> anyhow::Result<()>;

/// Asks for something, and says what to do if the board refuses it.
fn ask(client: &mut Client, command: Down) -> anyhow::Result<()> {
    match client.ask(&command, ANSWER_WITHIN)? {
        Answer::Done => Ok(()),
        Answer::Refused(Refusal::NotArmed) => bail!(
            "the board refuses {command:?}: nobody at the hand has consented. Contract both muscles for 2 s or press the blue \
             button, then start again within a minute"
        ),
        Answer::Refused(Refusal::Loaded) => {
            bail!("the board refuses {command:?}: something presses on the finger, or is held")
        }
        Answer::Refused(Refusal::SensorLost) => {
            bail!(
                "the board refuses {command:?}: the sensor it needs gives no number; `tenax monitor` says which"
            )
        }
        other => bail!("the board refuses {command:?}: {other:?}"),
    }
}

/// Looks at every message until `found` gives something.
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

/// The forces that a message tells.
fn forces(message: &Up) -> Option<Forces> {
    match message {
        Up::Slow(slow) => slow.forces,
        _ => None,
    }
}
