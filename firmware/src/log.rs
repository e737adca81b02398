//! The image's log, defmt over RTT, for a probe: a line for each start, mode, fault and refused command, by the levels of `DEFMT_LOG`.
//! Telemetry writes it, beside the message that it sends, and control does not: a line holds interrupts off for up to 900 instructions, a
//! restart's for 1,800. Without the feature `log` the image is 3 kB smaller.
//! Owns RTT.

use tenax_hal_shim::wire::Up;

#[cfg(feature = "log")]
pub fn told(message: &Up) {
    use defmt::{error, info, warn};
    use tenax_hal_shim::wire::{Answer, Event, EventKind};
    match message {
        Up::Hello { after: None, .. } => info!("started"),
        Up::Hello { after: Some(fault), .. } => {
            error!("restarted after {}: {=[u8]:a}", fault, crate::black_box::reason());
        }
        Up::Event(Event { frame, kind: EventKind::Mode { from, to, cause } }) => {
            info!("{=u32}: {} to {}: {}", frame, from, to, cause);
        }
        Up::Event(Event { frame, kind: EventKind::Fault(fault) }) => error!("{=u32}: {}", frame, fault),
        Up::Event(Event { frame, kind: EventKind::Motor(Some(stop)) }) => error!("{=u32}: {}", frame, stop),
        Up::Answer { of, answer: Answer::Refused(refusal), .. } => warn!("{=u16} refused: {}", of, refusal),
        _ => {}
    }
}

#[cfg(feature = "log")]
use defmt_rtt as _;

#[cfg(not(feature = "log"))]
pub fn told(_: &Up) {}
