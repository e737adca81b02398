//! Calibrations that tell a person step by step what to do at the hand. The board's readings say when a step is done.

pub mod force;

use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use tenax_frames::link::{ANSWER_WITHIN, Client};
use tenax_frames::words::refusal_words;
use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::wire::{Answer, Down, Event, EventKind, Forces, Up};
use tenax_hal_shim::words::{Calibration, GripMode, Prompt};

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

/// Time for three prompts of 5 s and the fit.
const PROMPTS_WITHIN: Duration = Duration::from_secs(30);

/// Passes on the board's prompts and tells the result. Fails if the board refuses; says why.
pub fn emg(client: &mut Client, say: Say<'_>) -> anyhow::Result<()> {
    ask(client, Down::CalibrateEmg)?;
    let separation_permille = wait_for(client, PROMPTS_WITHIN, "the board's prompts", |message| {
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

/// Load from which on the finger is pressed, and below which it is lifted, N.
const PRESSED_N: f64 = 0.6;
const LIFTED_N: f64 = 0.3;
/// Shortest stroke, slow frames: 0.3 s.
const STROKE: u32 = 24;
/// Time for all strokes; the board ends the behaviour after a minute.
const STROKES_WITHIN: Duration = Duration::from_secs(58);
const TOLD_WITHIN: Duration = Duration::from_secs(5);

/// Asks for strokes and tells friction and S2. Fails if the board refuses, or nothing slid.
pub fn friction(client: &mut Client, strokes: u32, say: Say<'_>) -> anyhow::Result<()> {
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
    let stroked = wait_for(client, STROKES_WITHIN, "the strokes", |message| {
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
