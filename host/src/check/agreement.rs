//! The image and the host's build of the logic, given the same codes, say the same, bit for bit.

use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, SCANS_PER_FRAME};
use tenax_hal_shim::frame::{Frame, Scan};
use tenax_hal_shim::wire::{Event, Slow};
use tenax_logic::fingertip::Fingertip;

use super::Bar;
use crate::board::Run;

/// What the host's build says to a run's codes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Said {
    /// Slow frames: every detector output and every command of every tick.
    pub slows: Vec<Slow>,
    /// Events.
    pub events: Vec<Event>,
}

/// Puts a run's codes through the host's build of the logic. The run must have had no commands and no lost frames.
#[must_use]
pub fn host_says(scans: &[Scan]) -> Said {
    let mut fingertip = Fingertip::default();
    let mut said = Said::default();
    let (frames, _) = scans.as_chunks::<SCANS_PER_FRAME>();
    for (sequence, scans) in (0..).zip(frames) {
        fingertip.tick(&Frame::from_scans(sequence, scans));
        said.slows.extend(fingertip.take_slow());
        said.events.extend(std::iter::from_fn(|| fingertip.next_event()));
    }
    said
}

/// The bar for a run on the emulated board.
#[must_use]
pub fn bar(run: &Run) -> Bar {
    const PROMISE: &str = "image = host logic, bit for bit, every detector output and command";
    let host = host_says(&run.scans);
    let ticks: usize = run.slows.iter().map(|slow| slow.ticks.len()).sum();
    // The board is switched off in the middle of a slow frame; what it had not yet sent cannot be compared.
    let whole = host.slows.len().saturating_sub(1);
    if run.slows.len() < whole {
        return Bar::new(
            PROMISE,
            format!("{} slow frames came up the line, {whole} were due", run.slows.len()),
            false,
        );
    }
    let differing: Vec<(&Slow, &Slow)> = run.slows.iter().zip(&host.slows).filter(|(a, b)| a != b).collect();
    let event = run.events.iter().zip(&host.events).find(|(image, host)| image != host);
    let figure = match (differing.first(), event) {
        (None, None) => {
            format!("{} slow frames with {ticks} ticks, {} events, equal", run.slows.len(), run.events.len())
        }
        (Some((image, host)), _) => {
            format!("{} slow frames differ, the first in {}", differing.len(), first_difference(image, host))
        }
        (None, Some((image, host))) => format!("image {image:?}, host {host:?}"),
    };
    Bar::new(PROMISE, figure, differing.is_empty() && event.is_none())
}

/// Where two slow frames begin to differ.
fn first_difference(image: &Slow, host: &Slow) -> String {
    let first = image.frame.saturating_sub(u32::from(FRAMES_PER_SLOW_FRAME) - 1);
    match (first..).zip(image.ticks.iter().zip(&host.ticks)).find(|(_, (image, host))| image != host) {
        Some((frame, (image, host))) => format!("frame {frame}: image {image:?}, host {host:?}"),
        None => {
            let without_ticks = |slow: &Slow| Slow { ticks: Default::default(), ..slow.clone() };
            format!("frame {}: image {:?}, host {:?}", image.frame, without_ticks(image), without_ticks(host))
        }
    }
}
