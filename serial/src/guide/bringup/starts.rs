//! How the board starts: after it was switched on, and after its supply has sagged.

use std::time::Duration;

use tenax_hal_shim::channel::{CHANNELS, Channel, mv_from_sample};
use tenax_hal_shim::wire::{EventKind, SCHEMA, Up};
use tenax_hal_shim::words::Fault;

use super::wire::{Stream, Wire};
use super::{Asked, Figure};
use crate::guide::Say;
use crate::words::{AboutWords, in_words};

/// How long a person may take.
const PATIENCE: Duration = Duration::from_secs(300);
/// How long a board is watched after its start.
const WATCHED: Duration = Duration::from_secs(5);
const SENSES: Stream = Stream { raw: false, senses: true };

/// Whether a fault is the board's, and none of a sensor that is not fitted yet.
const fn is_boards(fault: &Fault) -> bool {
    !matches!(
        fault,
        Fault::SensorLost { .. }
            | Fault::SensorBack { .. }
            | Fault::CapabilityLost(_)
            | Fault::CapabilityBack(_)
            | Fault::PressedAtBoot { .. }
            | Fault::NeverUnloaded
    )
}

/// Switched on: it starts after no fault, reports none, and takes its frames.
pub(super) fn power(wire: &mut Wire<'_>, asked: &Asked, say: Say<'_>) -> anyhow::Result<Vec<Figure>> {
    let after = wire.start(PATIENCE, &mut |_| ())?;
    say(&after.map_or_else(|| "It was switched on, or reset.".to_owned(), |fault| in_words(&fault)))?;
    let lasts = asked.lasts.unwrap_or(WATCHED);
    let (mut faults, mut schemas, mut working, mut frames) = (0, 0, 0, 0);
    wire.hear(lasts, SENSES, &mut |_, message| {
        match message {
            Up::About(about) => {
                schemas += u32::from(about.schema != SCHEMA);
                say(&AboutWords(about).to_string())?;
            }
            Up::Event(event) => {
                if let EventKind::Fault(fault) = event.kind
                    && is_boards(&fault)
                {
                    faults += 1;
                    say(&in_words(&fault))?;
                }
            }
            Up::Slow(slow) => frames = slow.frame + 1,
            Up::Senses(senses) => {
                let channels = CHANNELS.iter().zip(senses.samples);
                let works = |(channel, sample): &(&Channel, u16)| {
                    (channel.low_mv..=channel.high_mv).contains(&mv_from_sample(*sample))
                };
                working = channels.filter(works).count() as u32;
            }
            _ => {}
        }
        Ok(false)
    })?;
    Ok(vec![
        Figure::none("starts after a fault", u8::from(after.is_some())),
        Figure::none("faults of the board", faults),
        Figure::none("messages of other sources than this tool's", schemas),
        Figure::told("frames since its start", frames, "").within(1.0, f64::INFINITY),
        Figure::told("channels within their voltages", working, ""),
    ])
}

/// The supply sags and comes back: the board stops in order, says why, and starts.
pub(super) fn sweep(wire: &mut Wire<'_>, asked: &Asked, say: Say<'_>) -> anyhow::Result<Vec<Figure>> {
    let times = asked.times.unwrap_or(3);
    let (mut sagged, mut off, mut other, mut lost) = (0, 0, 0, 0);
    for n in 1..=times {
        say(&format!("{n} of {times}: lower it, and raise it."))?;
        let mut before = 0;
        let why = wire.start(PATIENCE, &mut |message| {
            if let Up::Counters(counters) = message {
                before = counters.frames_lost;
            }
        })?;
        lost += before;
        say(&why.map_or_else(|| "   switched on".to_owned(), |fault| format!("   {}", in_words(&fault))))?;
        match why {
            Some(Fault::SupplySagged) => sagged += 1,
            None => off += 1,
            Some(_) => other += 1,
        }
    }
    let times = f64::from(times);
    Ok(vec![
        Figure::told("starts after a sagging supply", sagged, "").within(times, times),
        Figure::none("starts that forgot why: lowered too far, or too fast", off),
        Figure::none("starts after another fault", other),
        Figure::none("frames lost before", lost),
    ])
}
