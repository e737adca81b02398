//! Calibration of S2 by strokes over the surface that is to be held.

use std::time::Duration;

use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::wire::{Down, EventKind, Up};
use tenax_hal_shim::words::GripMode;

use super::{Say, ask, forces, wait_for};
use tenax_frames::link::Client;

/// Load from which on the finger is pressed, and below which it is lifted, N.
const PRESSED_N: f64 = 0.6;
const LIFTED_N: f64 = 0.3;
/// Shortest stroke, slow frames: 0.3 s.
const STROKE: u32 = 24;
/// Time for all strokes; the board ends the behaviour after a minute.
const PATIENCE: Duration = Duration::from_secs(58);
const TOLD_WITHIN: Duration = Duration::from_secs(5);

/// Asks for strokes and tells friction and S2. Fails if the board refuses, or nothing slid.
pub fn calibrate(client: &mut Client, strokes: u32, say: Say<'_>) -> anyhow::Result<()> {
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
    // The reflex is back, whatever came of the strokes.
    ask(client, Down::End)?;
    stroked?;
    let measured = wait_for(client, TOLD_WITHIN, "what the strokes measured: nothing slid", |message| {
        let Up::Event(event) = message else { return Ok(None) };
        Ok(match event.kind {
            EventKind::Stroke { mu_s_permille, s2_permille } => Some([mu_s_permille, s2_permille]),
            _ => None,
        })
    })?;
    let [mu_s, s2] = measured.map(|permille| f64::from(permille) / 1e3);
    say(&format!("Static friction {mu_s:.3} on the scale of Ft/Fn; S2 is {s2:.3} from now on, and kept."))
}
