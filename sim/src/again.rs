//! A recording that begins at the board's start and has every frame, decided once more by the host's build of the logic:
//! a fault in the field, at the desk.

use std::fmt;

use anyhow::{Context, bail, ensure};
use tenax_frames::link::Inbox;
use tenax_frames::link::captured::line_of;
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::wire::{Down, Event, Identity, Received, ResetCause, Restored, Slow, Up};
use tenax_logic::device::Device;

use crate::board::agreement::{first, host_decides, presses, slow_difference};

#[derive(Debug, Default)]
pub struct Recorded {
    identity: Identity,
    restored: Vec<Restored>,
    frames: Vec<Frame>,
    commands: Vec<(u32, Received<Down>)>,
    slows: Vec<Slow>,
    events: Vec<Event>,
}

impl Recorded {
    /// From a line's bytes; of several starts, the last. Fails if something that decides is not in them.
    pub fn of(line: &[u8]) -> anyhow::Result<Self> {
        let (mut inbox, mut recorded, mut starts) = (Inbox::default(), Self::default(), 0);
        for heard in line.iter().filter_map(|&byte| inbox.push(byte)).flatten() {
            match heard.received.message {
                Up::Hello { .. } => {
                    recorded = Self::default();
                    starts += 1;
                }
                Up::About(about) => recorded.identity = about.identity,
                Up::Restored(restored) => recorded.restored.push(restored),
                Up::Raw(raw) => recorded.frames.extend(raw.frames()),
                Up::Taken { before, of, command } => {
                    recorded.commands.push((before, Received { sequence: of, message: command }));
                }
                Up::Slow(slow) => recorded.slows.push(slow),
                Up::Event(event) => recorded.events.push(event),
                _ => {}
            }
        }
        let how = "set stream-at-start-flag to 1, switch the board off and on, and record from before that; of a scene, \
                   `tenax run --record FILE.mcap`";
        ensure!(
            starts > 0,
            "the recording does not begin before the board's start, so its state is not known: {how}"
        );
        ensure!(!recorded.frames.is_empty(), "the recording has no frames: {how}");
        if let Some((n, frame)) = (0..).zip(&recorded.frames).find(|(n, frame)| frame.sequence != *n) {
            let after = frame.sequence;
            bail!(
                "frame {n} is missing, and after it comes {after}: what was decided after it cannot be repeated"
            );
        }
        Ok(recorded)
    }

    pub fn replay(&self) -> Outcome {
        let mut device = Device::default();
        for Restored { kept, payload } in &self.restored {
            device.restore(*kept, payload);
        }
        if self.identity.reset != ResetCause::PowerOn {
            device.fingertip.was_reset();
        }
        device.start(self.identity);
        let frames = self.frames.iter().copied();
        let said = host_decides(frames, device, &presses(&self.events), &self.commands);
        Outcome {
            frames: self.frames.len(),
            commands: self.commands.len(),
            slows: self.slows.len(),
            events: self.events.len(),
            difference: self.difference(&said.slows, &said.events),
        }
    }

    fn difference(&self, slows: &[Slow], events: &[Event]) -> Option<String> {
        let mut host = slows.iter();
        for board in self.slows.iter().filter(|slow| (slow.frame as usize) < self.frames.len()) {
            match host.find(|slow| slow.frame == board.frame) {
                None => return Some(format!("the host has no slow frame {}", board.frame)),
                Some(host) if host != board => return Some(slow_difference(board, host)),
                Some(_) => {}
            }
        }
        let end = self.slows.last().map_or(0, |slow| slow.frame);
        let [board, host] = [&self.events[..], events].map(|events| -> Vec<Event> {
            events.iter().filter(|event| event.frame < end).copied().collect()
        });
        first("event", &board, &host, host.len())
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    pub frames: usize,
    pub commands: usize,
    pub slows: usize,
    pub events: usize,
    pub difference: Option<String>,
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frames, commands, slows, events, difference } = self;
        match difference {
            Some(difference) => write!(f, "DIFFERS: {difference}"),
            None => write!(
                f,
                "{frames} frames, {commands} commands: {slows} slow frames and {events} events equal, bit for bit"
            ),
        }
    }
}

/// Replays the recording at `path`. Fails as [`Recorded::of`] does.
pub fn replay(path: &std::path::Path) -> anyhow::Result<Outcome> {
    Ok(Recorded::of(&line_of(path)?).with_context(|| path.display().to_string())?.replay())
}
