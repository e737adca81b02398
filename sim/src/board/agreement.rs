//! Whether a board and the host's build of the logic, given the same codes and the same commands in the same ticks, say
//! the same, bit for bit.

use std::fmt;

use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, SCANS_PER_FRAME};
use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::Duty;
use tenax_hal_shim::schedule::{Job, slot_of};
use tenax_hal_shim::wire::{Answer, Down, Event, EventKind, Received, Slow, Up};
use tenax_hal_shim::words::Consent;
use tenax_logic::arming::DEBOUNCE_FRAMES;
use tenax_logic::device::Device;

use super::Run;
use super::kept::Provision;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Said {
    pub slows: Vec<Slow>,
    pub events: Vec<Event>,
    pub answers: Vec<Answer>,
    pub feedback: Vec<(u32, Duty)>,
    pub slip_and_warning: Vec<[DetectorSet; 2]>,
}

impl Said {
    fn take(&mut self, message: Up) {
        match message {
            Up::Slow(slow) => self.slows.push(slow),
            Up::Event(event) => self.events.push(event),
            Up::Answer { answer, .. } => self.answers.push(answer),
            _ => {}
        }
    }
}

/// The host's decisions on a run's codes and commands. Scans that do not fill a frame are left out.
pub fn host_says(run: &Run) -> Said {
    let (frames, _) = run.scans.as_chunks::<SCANS_PER_FRAME>();
    let frames = (0..).zip(frames).map(|(sequence, scans)| Frame::from_scans(sequence, scans));
    let provision =
        Provision { trusts_line: run.trusts_line, calibrated: run.calibrated, ..Provision::default() };
    host_decides(frames, provision.device(), &presses(&run.events), &run.taken)
}

/// Puts frames of any board, none of them lost, through the host's build of the logic: `device` as it was before the start, the frames of
/// each press of the button, and each command with the frame before whose tick it was taken.
pub fn host_decides(
    frames: impl Iterator<Item = Frame>,
    mut device: Device,
    pressed: &[u32],
    commands: &[(u32, Received<Down>)],
) -> Said {
    let mut said = Said::default();
    let mut commands = commands.iter().peekable();
    for frame in frames {
        let sequence = frame.sequence;
        while let Some((_, command)) = commands.next_if(|(at, _)| *at <= sequence) {
            said.take(device.command(command));
        }
        device
            .fingertip
            .button(pressed.iter().any(|at| (at - at.min(&(DEBOUNCE_FRAMES - 1))..=*at).contains(&sequence)));
        device.tick(&frame);
        if frame.slot() == slot_of(Job::Save) {
            let duty = device.fingertip.feedback();
            if said.feedback.last().map_or(Duty::default(), |last| last.1) != duty {
                said.feedback.push((sequence, duty));
            }
        }
        let fingertip = &device.fingertip;
        said.slip_and_warning.push([fingertip.slip(), fingertip.incipient()]);
        std::iter::from_fn(|| device.next_message()).for_each(|message| said.take(message));
    }
    said
}

pub fn presses(events: &[Event]) -> Vec<u32> {
    let of_button = |event: &&Event| event.kind == EventKind::Armed(Consent::Button);
    events.iter().filter(of_button).map(|event| event.frame).collect()
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Agreement {
    compared: String,
    difference: Option<String>,
}

impl Agreement {
    /// Between a run, which must have lost no frame and not restarted, and the host's logic.
    pub fn of(run: &Run) -> Self {
        Self::with_host(run).0
    }

    pub fn with_host(run: &Run) -> (Self, Said) {
        let host = host_says(run);
        let (slows, networks) = (run.slows.len(), run.networks().count());
        let ticks = slows * usize::from(FRAMES_PER_SLOW_FRAME);
        let mut compared = format!("{slows} slow frames with {ticks} ticks, {} events", run.events.len());
        for (count, what) in [
            (run.taken.len(), format!("{} commands' answers", run.taken.len())),
            (networks, format!("the network {networks} times")),
            (run.feedback.len(), format!("the vibration motor's {} steps", run.feedback.len())),
        ] {
            if count > 0 {
                compared += &format!(", {what}");
            }
        }
        (Self { compared, difference: difference(run, &host) }, host)
    }

    pub const fn holds(&self) -> bool {
        self.difference.is_none()
    }
}

impl fmt::Display for Agreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.difference {
            Some(difference) => write!(f, "DIFFERS: {difference}"),
            None => write!(f, "{}, equal", self.compared),
        }
    }
}

fn difference(run: &Run, host: &Said) -> Option<String> {
    if let Some((image, host)) = run.slows.iter().zip(&host.slows).find(|(image, host)| image != host) {
        return Some(slow_difference(image, host));
    }
    // The board is switched off in the middle of a slow frame; what it had not yet sent cannot be compared.
    let whole = host.slows.len().saturating_sub(1);
    if run.slows.len() < whole {
        return Some(format!("{} slow frames came up the line, {whole} were due", run.slows.len()));
    }
    let end = run.slows.last().map_or(0, |slow| slow.frame);
    let due = host.events.iter().filter(|event| event.frame < end).count();
    // What came after the last frame was answered too, and is no part of it.
    let answers: Vec<_> =
        run.answers.iter().take(run.taken.len()).map(|(_, answer)| answer.clone()).collect();
    first("event", &run.events, &host.events, due)
        .or_else(|| first("answer", &answers, &host.answers, run.taken.len()))
        .or_else(|| {
            let due = host.feedback.iter().filter(|(frame, _)| *frame < end).count();
            first("step of the vibration motor", &run.feedback, &host.feedback, due)
        })
}

/// The first difference of two lists, of which the board's has at least `due` entries.
pub(crate) fn first<T: PartialEq + fmt::Debug>(
    what: &str,
    image: &[T],
    host: &[T],
    due: usize,
) -> Option<String> {
    if let Some((n, (image, host))) =
        image.iter().zip(host).enumerate().find(|(_, (image, host))| image != host)
    {
        return Some(format!("{what} {n}: image {image:?}, host {host:?}"));
    }
    let (image, host) = (image.len(), host.len());
    (image < due || image > host).then(|| format!("{what}s: image {image}, host {host}"))
}

pub fn slow_difference(image: &Slow, host: &Slow) -> String {
    let first = image.frame.saturating_sub(u32::from(FRAMES_PER_SLOW_FRAME) - 1);
    match (first..).zip(image.ticks.iter().zip(&host.ticks)).find(|(_, (image, host))| image != host) {
        Some((frame, (image, host))) => format!("frame {frame}: image {image:?}, host {host:?}"),
        None => {
            let without_ticks = |slow: &Slow| Slow { ticks: Default::default(), ..slow.clone() };
            format!("frame {}: image {:?}, host {:?}", image.frame, without_ticks(image), without_ticks(host))
        }
    }
}
