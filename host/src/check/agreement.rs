//! The image and the host's build of the logic, given the same codes, say the same, bit for bit.

use tenax_hal_shim::channel::SCANS_PER_FRAME;
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
    let differs = run.slows.iter().zip(&host.slows).find(|(image, host)| image != host);
    let events_differ = run.events.iter().zip(&host.events).find(|(image, host)| image != host);
    match (differs, events_differ) {
        (None, None) => {
            let figure = format!(
                "{} slow frames with {ticks} ticks, {} events, equal",
                run.slows.len(),
                run.events.len()
            );
            Bar::new(PROMISE, figure, true)
        }
        (Some((image, host)), _) => Bar::new(
            PROMISE,
            format!("first difference in slow frame {}: {image:?}, host {host:?}", image.frame),
            false,
        ),
        (None, Some((image, host))) => {
            Bar::new(PROMISE, format!("first difference in event {image:?}, host {host:?}"), false)
        }
    }
}
