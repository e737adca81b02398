//! Why the chip started, from the flags that its resets leave and a mark in RAM, and whether it has restarted too often.
//!
//! RM0383, section 6.3.20: any reset sets the pin's flag, a brown-out its own as well, and switching on those and its own.
//! Flags stay until the next start clears them, so a reset in the first instants of a start adds to the ones before: the most
//! severe one is reported.

use tenax_hal_shim::wire::ResetCause;
use tenax_hal_shim::words::Fault;

/// Restarts in a row after which control still starts; the next one leaves the motor off. A hand that hangs, or pulls its supply
/// down, whenever it begins to close would close a little further each time.
pub const RESTARTS_MAX: u32 = 5;

/// The chip's reset flags.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flags {
    /// Power-on reset: the supply was off.
    pub power_on: bool,
    /// Brown-out reset, or power-on: the supply was below the brown-out level.
    pub brown_out: bool,
    /// Reset by the watchdog.
    pub watchdog: bool,
    /// Reset by software.
    pub software: bool,
    /// The reset pin, or any other reset.
    pub pin: bool,
}

/// Mark in RAM that the run before left when it reset the chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A panic or a fault of the core.
    Panicked,
    /// The voltage detector said that the supply falls.
    SupplySagged,
    /// The clock security system said that the crystal stopped.
    CrystalLost,
}

/// Cause of this start, and restarts before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Start {
    /// Why the chip started.
    pub cause: ResetCause,
    /// Why the last run ended, if not by switching off.
    pub after: Option<Fault>,
    /// Restarts in a row, to be kept until the next start.
    pub restarts: u32,
    /// Whether there were more than [`RESTARTS_MAX`] restarts in a row: only the button drives the motor.
    pub stay_off: bool,
}

/// Judges the cause of this start. `restarts`: the kept count of restarts in a row.
///
/// A restart counts if the hand caused it: its software by a panic or by hanging, its motor by pulling the supply down.
/// A lost crystal neither counts nor clears the count: the chip continues on its own oscillator.
#[must_use]
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
