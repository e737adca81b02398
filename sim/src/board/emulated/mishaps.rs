//! What can go wrong with a board, done to the emulated one.

use rigless::chip::uart::Rate;
use rigless::device::Level;
use rigless::emulator::{Access, AccessKind, Host, InterruptLine, Stop};
use rigless::session::Session;
use rigless::soc::Width;
use tenax_hal_shim::channel::SCAN_HZ;

use super::Mishap;
use super::flash::FlashArray;
use super::nucleo::{Nucleo, USART2};
use super::wires::{BRIDGE_FAULT, Wires};

/// DMA2 (RM0383, section 9.5): flags of streams 0 to 3, where a written one clears them, stream 0's configuration and address.
const DMA2_LISR: u64 = 0x4002_6400;
const DMA2_LIFCR: u64 = 0x4002_6408;
const DMA2_S0CR: u64 = 0x4002_6410;
const DMA2_S0M0AR: u64 = 0x4002_641C;
const TCIF0: u64 = 1 << 5;
const S0CR_EN: u64 = 1;
/// The voltage detector's interrupt (RM0383, table 37).
const PVD: InterruptLine = InterruptLine::new(1).expect("every core has it");
/// The voltage detector's output (RM0383, section 5.4.2).
const PWR_CSR: u64 = 0x4000_7004;
const PVDO: u64 = 1 << 2;
/// RCC's control, and its bits for the clock security system and the crystal (RM0383, section 6.3.1).
const RCC_CR: u64 = 0x4002_3800;
const CSSON: u64 = 1 << 19;
const HSEON: u64 = 1 << 16;
const PLLON: u64 = 1 << 24;
/// The PLL's configuration, and its bit for the crystal (section 6.3.2).
const RCC_PLLCFGR: u64 = 0x4002_3804;
const PLLSRC_HSE: u64 = 1 << 22;
const NMI_VECTOR: u64 = 0x0800_0008;
const PVD_VECTOR: u64 = 0x0800_0044;
const NOWHERE: u64 = 0x6000_0000;

pub struct Mishaps {
    due: Vec<(usize, Mishap)>,
    lent: Option<u64>,
    /// Bits of RCC's control that do nothing: [`HSEON`], or [`PLLON`] on the crystal.
    dead_clocks: u64,
    /// The converter's stream goes on when it is stopped next.
    stream_sticks: bool,
}

impl Mishaps {
    /// Those of `mishaps`, each at its time, s.
    pub fn new(mishaps: &[(f64, Mishap)]) -> Self {
        let scan = |at_s: f64| (at_s * f64::from(SCAN_HZ)) as usize;
        let due = mishaps.iter().map(|(at_s, mishap)| (scan(*at_s), mishap.clone())).collect();
        Self { due, lent: None, dead_clocks: 0, stream_sticks: false }
    }

    /// The core made an access. `rigless` finds a crystal's empty pin ready after its start-up time, at 0 Hz: it never gets so far.
    pub fn accessed(&mut self, access: &Access, session: &mut Session<Nucleo>) {
        let writes = |address| access.kind == AccessKind::Write && access.address == address;
        let (board, now) = (session.board_mut(), access.virtual_time);
        if writes(DMA2_S0CR) && std::mem::take(&mut self.stream_sticks) {
            let control = board.peek(now, DMA2_S0CR);
            board.poke(now, DMA2_S0CR, control | S0CR_EN);
        }
        if self.dead_clocks != 0 && writes(RCC_CR) {
            let on_crystal = board.peek(now, RCC_PLLCFGR) & PLLSRC_HSE != 0;
            let dead = self.dead_clocks & if on_crystal { HSEON | PLLON } else { HSEON };
            let control = board.peek(now, RCC_CR);
            if control & dead != 0 {
                board.poke(now, RCC_CR, control & !dead);
            }
        }
    }

    pub fn happen(
        &mut self,
        scan: usize,
        session: &mut Session<Nucleo>,
        stop: Stop,
        flash: &mut FlashArray,
        host: &mut dyn Host,
    ) {
        if let Some(own) = self.lent.take() {
            point_pvd_at(own, host);
        }
        let due: Vec<_> = self.due.extract_if(.., |(at, _)| *at <= scan).collect();
        let now = stop.at;
        for (_, mishap) in due {
            if matches!(mishap, Mishap::BrownsOut | Mishap::ResetByPin) {
                session.reset_by_pin(now, stop.instruction_count, host);
            }
            let board = session.board_mut();
            match mishap {
                Mishap::ResetByPin => {}
                Mishap::PllFails => self.dead_clocks = PLLON,
                Mishap::CoreStrays => self.lead_pvd_to(NOWHERE | 1, host),
                Mishap::BrownsOut => board.browned_out(now),
                Mishap::SupplyIs(mv) => {
                    board.chip.set_supply(mv);
                    // `rigless` leads the detector's output nowhere.
                    if board.peek(now, PWR_CSR) & PVDO != 0 {
                        interrupt(host);
                    }
                }
                Mishap::CrystalStops(comes_back) => {
                    self.dead_clocks = if comes_back { 0 } else { HSEON };
                    if board.peek(now, RCC_CR) & CSSON != 0 {
                        // `rigless` lets nobody raise the core's own exception: another's vector leads to its handler for an instant.
                        let handler = host.read(NMI_VECTOR, Width::W32).unwrap_or(0);
                        self.lead_pvd_to(handler, host);
                    }
                }
                Mishap::DmaStalls => {
                    let control = board.peek(now, DMA2_S0CR);
                    board.poke(now, DMA2_S0CR, control & !S0CR_EN);
                }
                Mishap::DmaSticks => self.stream_sticks = true,
                Mishap::DmaFails => {
                    let ended = board.peek(now, DMA2_LISR) & TCIF0;
                    let control = board.peek(now, DMA2_S0CR);
                    board.poke(now, DMA2_S0CR, control & !S0CR_EN);
                    // Its end is no end: the driver would read half a frame, and restart the ring before it has stumbled.
                    board.poke(now, DMA2_LIFCR, TCIF0 & !ended);
                    board.poke(now, DMA2_S0M0AR, NOWHERE);
                    board.poke(now, DMA2_S0CR, control);
                }
                Mishap::Garbage(bytes) => {
                    if let Some(line) = board.line() {
                        line.down.extend(bytes);
                    }
                }
                Mishap::LineErrs(per_million) => {
                    board.chip.usart[USART2].errors_mut().framing = Rate { name: "framing", per_million };
                }
                Mishap::CoreHangs => host.hold(true),
                Mishap::PowerFails(words) => flash.cut_power_after(words),
                Mishap::BridgeIsOff(is_off) => Wires::new(board, now).pull(BRIDGE_FAULT, is_off),
            }
        }
    }

    /// Raises the voltage detector's interrupt with another handler.
    fn lead_pvd_to(&mut self, handler: u64, host: &mut dyn Host) {
        self.lent = host.read(PVD_VECTOR, Width::W32).ok();
        point_pvd_at(handler, host);
        interrupt(host);
    }
}

fn interrupt(host: &mut dyn Host) {
    host.set_interrupt(PVD, Level::High);
    host.set_interrupt(PVD, Level::Low);
}

fn point_pvd_at(handler: u64, host: &mut dyn Host) {
    let placed = host.program(PVD_VECTOR, Width::W32, handler);
    debug_assert!(placed.is_ok(), "{PVD_VECTOR:#x} is in the flash");
}
