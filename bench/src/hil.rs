//! A real board in the loop: what can be measured over its line, and what can be decided once more from it.
//!
//! The project has these figures from emulation only. No scene is played into its inputs: that would take a converter for each of 42.
//! What its own inputs read is decided by the host's logic instead, and has to come out the same bit for bit.

use std::process::Command;
use std::time::{Duration, Instant};

use anyhow::{Context, ensure};
use serde::Serialize;
use tenax_hal_shim::wire::{Answer, Down, FRAME_MAX, Identity, ResetCause, Setting, Up, encode};
use tenax_logic::setting::SettingId;
use tenax_serial::guide::Say;
use tenax_serial::guide::bringup::{Asked, Figure, HARNESS, STEPS, Stream, Wire, harness, readings};
use tenax_serial::link::ANSWER_WITHIN;

use crate::again::Recorded;

/// Steps of bring-up that nothing has to be done for.
const ALONE: [&str; 3] = ["clock", "timing", "line"];
/// How long a person may take to press the reset button.
const PATIENCE: Duration = Duration::from_secs(60);
/// How long a setting may take to be saved: it is saved once in 3 s.
const SAVED_WITHIN: Duration = Duration::from_secs(5);
/// Resets through a probe.
const RESETS: u32 = 20;

#[derive(Clone, Debug)]
pub struct Fitted {
    /// How long each part is measured.
    pub lasts: Duration,
    /// A shell's command that resets the board. None: somebody presses its black button.
    pub reset: Option<String>,
    pub harness: bool,
}

/// What is written for whoever collects figures of boards.
#[derive(Debug, Default, Serialize)]
pub struct Report {
    /// Of the tool.
    pub version: &'static str,
    /// The image's build identifier and the chip's number.
    pub build: String,
    pub chip: String,
    pub part: Vec<Part>,
}

#[derive(Debug, Serialize)]
pub struct Part {
    pub name: &'static str,
    pub figure: Vec<Figure>,
}

impl Report {
    fn add(&mut self, name: &'static str, figure: Vec<Figure>, say: Say<'_>) -> anyhow::Result<()> {
        figure.iter().try_for_each(|figure| say(&figure.to_string()))?;
        self.part.push(Part { name, figure });
        Ok(())
    }

    pub fn passes(&self) -> bool {
        self.part.iter().flat_map(|part| &part.figure).all(Figure::passes)
    }
}

/// Measures all that can be. Fails if the line does.
pub fn measure(wire: &mut Wire<'_>, fitted: &Fitted, say: Say<'_>) -> anyhow::Result<Report> {
    let Identity { build, chip: [c0, c1, c2], .. } = match wire.client.ask(&Down::About, ANSWER_WITHIN)? {
        Answer::About(about) => about.identity,
        other => anyhow::bail!("the board does not say who it is: {other:?}"),
    };
    let mut report = Report {
        version: env!("CARGO_PKG_VERSION"),
        build: format!("{build:016x}"),
        chip: format!("{c0:08x}{c1:08x}{c2:08x}"),
        part: Vec::new(),
    };
    for step in STEPS.iter().filter(|step| ALONE.contains(&step.name)) {
        let asked = Asked { lasts: Some(fitted.lasts), ..Asked::default() };
        report.part.push(Part { name: step.name, figure: step.measure(wire, &asked, say)? });
    }
    report.part.push(Part { name: "readings", figure: readings(wire, fitted.lasts)? });
    if fitted.harness {
        say(HARNESS)?;
        report.add("harness", harness(wire, say)?, say)?;
    }
    report.add("decisions", decisions(wire, fitted, say)?, say)?;
    if let Some(reset) = &fitted.reset {
        report.add("resets", resets(wire, reset)?, say)?;
    }
    Ok(report)
}

fn reset(command: &str) -> anyhow::Result<()> {
    let status = Command::new("sh").args(["-c", command]).status()?;
    ensure!(status.success(), "`{command}` has failed");
    Ok(())
}

/// What the board decides from its start on is decided by the host's logic from the same frames.
fn decisions(wire: &mut Wire<'_>, fitted: &Fitted, say: Say<'_>) -> anyhow::Result<Vec<Figure>> {
    let id = SettingId::StreamAtStart.number();
    wire.ask(Down::Set(Setting { id, value: 1 }), say)?;
    wire.wait(SAVED_WITHIN, "the setting to be saved", Stream::default(), &mut |_, message| {
        Ok(matches!(message, Up::Saved { .. }))
    })?;
    match &fitted.reset {
        Some(command) => reset(command)?,
        None => say("Press the black button.")?,
    }
    // Numbered anew: frames that are missing are noticed by their own numbers.
    let (mut line, mut sequence) = (Vec::new(), 0_u16);
    let mut keep = |message: &Up| {
        sequence = sequence.wrapping_add(1);
        line.extend_from_slice(encode(sequence, message, &mut [0; FRAME_MAX]).unwrap_or_default());
    };
    let raw = Stream { raw: true, senses: false };
    wire.wait(PATIENCE, "the board to start", Stream::default(), &mut |_, message| {
        let starts = matches!(message, Up::Hello { .. });
        if starts {
            keep(message);
        }
        Ok(starts)
    })?;
    wire.hear(fitted.lasts, raw, &mut |_, message| {
        keep(message);
        Ok(false)
    })?;
    wire.ask(Down::Set(Setting { id, value: 0 }), say)?;
    let outcome = Recorded::of(&line).context("what the board sampled from its start on")?.replay();
    say(&format!("   {outcome}"))?;
    Ok(vec![
        Figure::told("frames decided once more", outcome.frames as f64, "").within(1.0, f64::INFINITY),
        Figure::told("slow frames compared", outcome.slows as f64, "").within(1.0, f64::INFINITY),
        Figure::none("differences", u8::from(outcome.difference.is_some())),
    ])
}

/// Resets through a probe: each start tells it as what it was.
fn resets(wire: &mut Wire<'_>, command: &str) -> anyhow::Result<Vec<Figure>> {
    let (mut wrong, mut longest_s) = (0_u32, 0.0_f64);
    for _ in 0..RESETS {
        reset(command)?;
        let began = Instant::now();
        let (mut after, mut cause) = (None, None);
        wire.wait(PATIENCE, "the board to start", Stream::default(), &mut |_, message| {
            match message {
                Up::Hello { after: why, .. } => after = *why,
                Up::About(about) => cause = Some(about.identity.reset),
                _ => {}
            }
            Ok(cause.is_some())
        })?;
        longest_s = longest_s.max(began.elapsed().as_secs_f64());
        wrong += u32::from(after.is_some() || !matches!(cause, Some(ResetCause::Software | ResetCause::Pin)));
    }
    Ok(vec![
        Figure::told("resets", RESETS, ""),
        Figure::none("told as something else", wrong),
        Figure::told("longest until the board says who it is", longest_s, "s"),
    ])
}
