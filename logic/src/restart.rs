//! Cause of a start from the chip's reset flags and a mark in RAM. Flags stay until a start clears them and
//! may add up (RM0383, section 6.3.20): the most severe one is reported.

use tenax_hal_shim::wire::ResetCause;
use tenax_hal_shim::words::Fault;

/// Restarts in a row after which control still starts; the next one leaves the motor off.
pub const RESTARTS_MAX: u32 = 5;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flags {
    pub power_on: bool,
    pub brown_out: bool,
    pub watchdog: bool,
    pub software: bool,
    pub pin: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    Panicked,
    SupplySagged,
    CrystalLost,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Start {
    pub cause: ResetCause,
    pub after: Option<Fault>,
    pub restarts: u32,
    pub stay_off: bool,
}

/// `restarts`: kept count of restarts in a row, of panics, hangs and brown-outs. A lost crystal neither counts
/// nor clears the count.
pub fn judge(flags: Flags, mark: Option<Mark>, restarts: u32) -> Start {
    let mark = mark.filter(|_| flags.software);
    let (cause, after) = match (flags, mark) {
        (Flags { power_on: true, .. }, _) => (ResetCause::PowerOn, None),
        (Flags { brown_out: true, .. }, _) => (ResetCause::Other, Some(Fault::SupplySagged)),
        (Flags { watchdog: true, .. }, _) => (ResetCause::Watchdog, Some(Fault::WatchdogReset)),
        (_, Some(Mark::Panicked)) => (ResetCause::Panic, Some(Fault::PanicReset)),
        (_, Some(Mark::SupplySagged)) => (ResetCause::Software, Some(Fault::SupplySagged)),
        (_, Some(Mark::CrystalLost)) => (ResetCause::Software, Some(Fault::CrystalLost)),
        (Flags { software: true, .. }, None) => (ResetCause::Software, None),
        (Flags { pin: true, .. }, None) => (ResetCause::Pin, None),
        _ => (ResetCause::Other, None),
    };
    let restarts = match after {
        None => 0,
        Some(Fault::CrystalLost) => restarts.min(RESTARTS_MAX),
        Some(_) => restarts.saturating_add(1),
    };
    let stay_off = restarts > RESTARTS_MAX;
    Start { cause, after: if stay_off { Some(Fault::TooManyRestarts) } else { after }, restarts, stay_off }
}
