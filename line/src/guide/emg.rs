//! Calibration of the myosensors: rest, close, open, as the board asks for them.

use std::time::Duration;

use anyhow::bail;
use tenax_hal_shim::wire::{Down, Event, EventKind, Up};
use tenax_hal_shim::words::{Calibration, Prompt};

use super::{Say, ask, wait_for};
use tenax_frames::link::Client;

/// Time for three prompts of 5 s and the fit.
const PATIENCE: Duration = Duration::from_secs(30);

/// Passes on the board's prompts and tells the result. Fails if the board refuses; says why.
pub fn calibrate(client: &mut Client, say: Say<'_>) -> anyhow::Result<()> {
    ask(client, Down::CalibrateEmg)?;
    let separation_permille = wait_for(client, PATIENCE, "the board's prompts", |message| {
        let Up::Event(Event { kind: EventKind::Calibration(calibration), .. }) = message else {
            return Ok(None);
        };
        match *calibration {
            Calibration::Asks(prompt) => {
                let (n, hint) = match prompt {
                    Prompt::Rest => (1, ""),
                    Prompt::Close => (2, ". Flexing the wrist is best for most"),
                    Prompt::Open => (3, ". Extending the wrist is best for most"),
                };
                say(&format!("{n} of 3, for 5 s: {}{hint}.", prompt.name()))?;
                Ok(None)
            }
            Calibration::Done { separation_permille } => Ok(Some(separation_permille)),
            Calibration::Refused(why) => {
                bail!(
                    "not taken: {why}. The calibration before is still in force (docs/emg.md says what helps)"
                )
            }
            Calibration::Fit(_) => Ok(None),
        }
    })?;
    say(&format!(
        "Taken, and kept: rest, closing and opening are {:.1} deviations apart (3 are needed).",
        f64::from(separation_permille) / 1e3
    ))
}
