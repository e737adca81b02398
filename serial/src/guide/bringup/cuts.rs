//! The power is cut while a setting is saved: what comes back is the value before or the one after.

use std::process::Command;
use std::thread;
use std::time::Duration;

use anyhow::ensure;
use tenax_hal_shim::wire::{Down, EventKind, Setting, Up};
use tenax_hal_shim::words::{Fault, Kept};
use tenax_logic::setting::SettingId;

use super::wire::{Stream, Wire};
use super::{Asked, Figure};
use crate::guide::Say;

/// The setting that is changed, by one.
const CHANGED: SettingId = SettingId::S1;
/// A record takes 0.1 s to save: the power is cut at a different instant each time, within so many ms.
const SAVING_MS: u32 = 200;
/// How long a person may take.
const PATIENCE: Duration = Duration::from_secs(120);
/// How long what a start says is listened to.
const STARTED: Duration = Duration::from_millis(500);

/// The flash did not take a record, or has no room for it.
const fn is_refused(message: &Up) -> bool {
    matches!(message, Up::Event(event)
        if matches!(event.kind, EventKind::Fault(Fault::StoreFailed(_) | Fault::StoreFull(_))))
}

/// Cuts the power again and again.
pub(super) fn cuts(wire: &mut Wire<'_>, asked: &Asked, say: Say<'_>) -> anyhow::Result<Vec<Figure>> {
    let times = asked.times.unwrap_or(100);
    let first = wire.client.setting(CHANGED)?;
    let other = if first > CHANGED.row().min { first - 1 } else { first + 1 };
    let (mut kept, mut new, mut forgotten, mut foreign, mut failed) = (first, 0, 0, 0, 0);
    for n in 1..=times {
        let next = if kept == first { other } else { first };
        wire.ask(Down::Set(Setting { id: CHANGED.number(), value: next }), say)?;
        match &asked.cut_power {
            None => say(&format!("{n} of {times}: cut the power, and restore it."))?,
            Some(command) => {
                thread::sleep(Duration::from_millis((n * 37 % SAVING_MS).into()));
                let status = Command::new("sh").args(["-c", command]).status()?;
                ensure!(status.success(), "`{command}` has failed");
            }
        }
        let mut saved = false;
        let fault = wire.start(PATIENCE, &mut |message| {
            saved |= matches!(message, Up::Saved { kept: Kept::Settings, .. });
            failed += u32::from(is_refused(message));
        })?;
        wire.hear(STARTED, Stream::default(), &mut |_, message| {
            failed += u32::from(is_refused(message));
            Ok(false)
        })?;
        failed += u32::from(!matches!(fault, None | Some(Fault::SupplySagged)));
        let now = wire.client.setting(CHANGED)?;
        new += u32::from(now == next);
        forgotten += u32::from(saved && now != next);
        foreign += u32::from(now != next && now != kept);
        kept = now;
    }
    if kept != first {
        wire.ask(Down::Set(Setting { id: CHANGED.number(), value: first }), say)?;
    }
    Ok(vec![
        Figure::told("power cuts", times, ""),
        Figure::none("starts with another value than before or after", foreign),
        Figure::none("values that were told as saved and are not", forgotten),
        Figure::none("starts after a fault, records not taken", failed),
        Figure::told("starts with the new value", new, ""),
    ])
}
