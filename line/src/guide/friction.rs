//! Friction by strokes over the surface that is to be held: S2 follows.

use std::time::Duration;

use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::wire::{Down, EventKind, Up};
use tenax_hal_shim::words::GripMode;

use super::{Say, ask, forces, wait_for};
use tenax_frames::link::Client;

/// From this load on it is a stroke, and below this part of it the finger is lifted, N.
const PRESSED_N: f64 = 0.6;
const LIFTED_N: f64 = 0.3;
/// A stroke lasts for so many slow frames at least: 0.3 s.
const STROKE: u32 = 24;
/// How long a person may take for all of them; the board ends a stroke by itself after a minute.
const PATIENCE: Duration = Duration::from_secs(58);
const TOLD_WITHIN: Duration = Duration::from_secs(5);

/// What the strokes measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measured {
    /// Static friction, on the scale of the board's ratio, per mille.
    pub mu_s_permille: u16,
    /// The S2 that is in force and kept from now on, per mille.
    pub s2_permille: u16,
}

/// Has so many strokes done. Fails if the board refuses, or nothing slid.
pub fn calibrate(client: &mut Client, strokes: u32, say: Say<'_>) -> anyhow::Result<Measured> {
    // A board that was just switched on knows its sensors a moment later, and a muscle may still be relaxing.
    let ready = "the hand to be at rest with every sensor that the reflex needs; `tenax monitor` says which is missing";
    wait_for(client, TOLD_WITHIN, ready, |message| {
        Ok(match message {
            Up::Slow(slow) if matches!(slow.mode, GripMode::Watch | GripMode::Settle) => Some(()),
            _ => None,
        })
    })?;
    ask(client, Down::Begin(Behaviour::Stroke))?;
    say(&format!(
        "{strokes} strokes: press the finger on the surface with 1 to 5 N, draw it over it for some centimetres, and lift it."
    ))?;
    let (mut done, mut pressed, mut highest) = (0, 0, 0);
    let stroked = wait_for(client, PATIENCE, "the strokes", |message| {
        let Some(forces) = forces(message) else { return Ok(None) };
        let load = f64::from(forces.load_mn) / 1e3;
        if load >= PRESSED_N {
            pressed += 1;
            highest = highest.max(forces.ratio_permille.unwrap_or(0));
        } else if load < LIFTED_N && pressed > 0 {
            if pressed >= STROKE {
                done += 1;
                say(&format!("   {done} of {strokes}: Ft/Fn up to {:.3}", f64::from(highest) / 1e3))?;
            }
            (pressed, highest) = (0, 0);
        }
        Ok((done >= strokes).then_some(()))
    });
    // Whatever came of it, the reflex is wanted back.
    ask(client, Down::End)?;
    stroked?;
    wait_for(client, TOLD_WITHIN, "what the strokes measured: nothing slid", |message| {
        Ok(match message {
            Up::Event(event) => match event.kind {
                EventKind::Stroke { mu_s_permille, s2_permille } => {
                    Some(Measured { mu_s_permille, s2_permille })
                }
                _ => None,
            },
            _ => None,
        })
    })
}
