//! The wearer's muscles: rest, close, open, as the board asks for them.

use std::time::Duration;

use anyhow::bail;
use tenax_hal_shim::wire::{Down, EventKind, Up};
use tenax_hal_shim::words::{Calibration, Prompt};

use super::{Say, ask, wait_for};
use tenax_frames::link::Client;

/// Three prompts of 5 s, and what is thought about them.
const PATIENCE: Duration = Duration::from_secs(30);

/// Follows the board's prompts to the end; gives the distance of the states in their deviations. An error says why the board refused it.
pub fn calibrate(client: &mut Client, say: Say<'_>) -> anyhow::Result<f64> {
    ask(client, Down::CalibrateEmg)?;
    wait_for(client, PATIENCE, "the board's prompts", |message| {
        let Up::Event(event) = message else { return Ok(None) };
        match event.kind {
            EventKind::Calibration(Calibration::Asks(prompt)) => {
                say(match prompt {
                    Prompt::Rest => "1 of 3, for 5 s: let the arm lie and relax.",
                    Prompt::Close => {
                        "2 of 3, for 5 s: hold the contraction that shall close the hand. Flexing the wrist is best for most."
                    }
                    Prompt::Open => {
                        "3 of 3, for 5 s: hold the contraction that shall open the hand. Extending the wrist is best for most."
                    }
                })?;
                Ok(None)
            }
            EventKind::Calibration(Calibration::Done { separation_permille }) => {
                Ok(Some(f64::from(separation_permille) / 1e3))
            }
            EventKind::Calibration(Calibration::Refused(why)) => {
                bail!(
                    "not taken: {why}. The calibration before is still in force (docs/emg.md says what helps)"
                )
            }
            _ => Ok(None),
        }
    })
}
