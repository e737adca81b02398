//! What can go wrong with a board, done to the emulated one.

use rigless::emulator::{Host, Stop};
use rigless::mcu::Operate;
use rigless::session::Session;
use rigless::soc::Width;
use rigless::time::VirtualNanos;
use tenax_hal_shim::channel::SCAN_HZ;

use super::Mishap;
use super::wires::Wires;
use tenax_board_model::flash::FlashArray;
use tenax_board_model::nucleo::Nucleo;
use tenax_board_model::part::Part;

/// DMA2's flags of its streams 0 to 3, and where a written one clears them.
const DMA2_LISR: u64 = 0x4002_6400;
const DMA2_LIFCR: u64 = 0x4002_6408;
/// The flag that stream 0 has come to its end.
const TCIF0: u64 = 1 << 5;
/// DMA2 stream 0's configuration: bit 0 switches it on.
const DMA2_S0CR: u64 = 0x4002_6410;
/// DMA2 stream 0's address in memory.
const DMA2_S0M0AR: u64 = 0x4002_641C;
/// No chip of the family has anything there.
const NOWHERE: u64 = 0x6000_0000;

/// What is still to happen, each with the scan at which it does.
pub struct Mishaps(Vec<(usize, Mishap)>);

impl Mishaps {
    /// Those of `mishaps`, each at its time, s.
    pub fn new(mishaps: &[(f64, Mishap)]) -> Self {
        let scan = |at_s: f64| (at_s * f64::from(SCAN_HZ)) as usize;
        Self(mishaps.iter().map(|(at_s, mishap)| (scan(*at_s), mishap.clone())).collect())
    }

    /// Does what is due at `scan`.
    pub fn happen(
        &mut self,
        scan: usize,
        session: &mut Session<Nucleo>,
        stop: Stop,
        flash: &mut FlashArray,
        host: &mut dyn Host,
    ) {
        let due: Vec<_> = self.0.extract_if(.., |(at, _)| *at <= scan).collect();
        let now = stop.at;
        for (_, mishap) in due {
            if mishap == Mishap::BrownsOut {
                session.reset_by_pin(now, stop.instruction_count, host);
                session.board_mut().mcu.browned_out(now);
                continue;
            }
            let mcu = &mut session.board_mut().mcu;
            match mishap {
                Mishap::BrownsOut => {}
                Mishap::DmaStalls => {
                    stop_stream(mcu, now);
                }
                Mishap::DmaFails => {
                    let ended = flags(mcu, now) & TCIF0;
                    let control = stop_stream(mcu, now);
                    // That it was stopped for this is no end: the driver would read a frame that is not whole, and send the stream
                    // back to its ring before it has stumbled.
                    set(mcu, now, DMA2_LIFCR, TCIF0 & !ended);
                    set(mcu, now, DMA2_S0M0AR, NOWHERE);
                    set(mcu, now, DMA2_S0CR, control);
                }
                Mishap::Garbage(bytes) => {
                    if let Some(line) = mcu.line(now) {
                        line.down.extend(bytes);
                    }
                }
                Mishap::CoreHangs => host.hold(true),
                Mishap::PowerFails { words } => flash.cut_power_after(words),
                Mishap::BridgeIsOff(is_off) => Wires::new(mcu, now).bridge_fault(is_off),
            }
        }
    }
}

/// Switches the converter's stream off; gives its configuration before.
fn stop_stream(mcu: &mut Part, now: VirtualNanos) -> u64 {
    let control = mcu.peek(now, DMA2_S0CR, Width::W32).unwrap_or(0);
    set(mcu, now, DMA2_S0CR, control & !1);
    control
}

fn flags(mcu: &mut Part, now: VirtualNanos) -> u64 {
    mcu.peek(now, DMA2_LISR, Width::W32).unwrap_or(0)
}

fn set(mcu: &mut Part, now: VirtualNanos, address: u64, value: u64) {
    let written = mcu.write(now, address, Width::W32, value);
    debug_assert!(written.is_ok(), "{address:#x} is a register of the chip");
}
