//! What happens when the image can go on no longer, and how the next start knows.
//!
//! First the bridge goes off; everything else comes after. Then a mark is left in RAM, which a reset does not clear, and
//! the chip is reset.

use core::mem::MaybeUninit;
use core::panic::PanicInfo;
use core::ptr::{addr_of, addr_of_mut};

use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};
use embassy_stm32::pac;
use tenax_hal_shim::wire::ResetCause;
use tenax_hal_shim::words::Fault;

use crate::{black_box, bridge};

/// Restarts in a row, each sooner than [`lived_well`] after the one before, after which the hand stays off: a hand that
/// hangs as it begins to close would close a little further each time.
const RESTARTS_MAX: u32 = 5;

/// Why the image ended. Any other value is what RAM held at power-on.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum Mark {
    /// A panic or a fault of the core.
    Panicked = 0x7E4A_C0DE,
    /// The supply fell below what the chip needs.
    SupplySagged = 0x7E4A_BA77,
    /// The crystal stopped.
    CrystalLost = 0x7E4A_C10C,
}

/// What a reset does not clear: not initialised by the runtime.
#[unsafe(link_section = ".uninit.mark")]
static mut KEPT: MaybeUninit<[u32; 2]> = MaybeUninit::uninit();
/// Where the mark is in it, and the restarts in a row.
const MARK: usize = 0;
const RESTARTS: usize = 1;

/// How this run began.
pub struct Start {
    /// Why the last run ended, if not by switching off.
    pub after: Option<Fault>,
    /// Why the chip started.
    pub cause: ResetCause,
    /// It has restarted too often: nothing is to move any more.
    pub stay_off: bool,
}

/// How this run began. Asked once, before anything else is set up: it forgets the answer.
pub fn start() -> Start {
    let csr = pac::RCC.csr().read();
    pac::RCC.csr().modify(|w| w.set_rmvf(true));
    let mark = kept(MARK);
    keep(MARK, 0);
    let left = |own: Mark| csr.sftrstf() && mark == own as u32;
    let (cause, after) = if csr.porrstf() {
        (ResetCause::PowerOn, None)
    } else if csr.wdgrstf() {
        (ResetCause::Watchdog, Some(Fault::WatchdogReset))
    } else if left(Mark::Panicked) {
        (ResetCause::Panic, Some(Fault::PanicReset))
    } else if left(Mark::SupplySagged) {
        (ResetCause::Software, Some(Fault::SupplySagged))
    } else if left(Mark::CrystalLost) {
        (ResetCause::Software, Some(Fault::CrystalLost))
    } else if csr.sftrstf() {
        (ResetCause::Software, None)
    } else if csr.padrstf() {
        (ResetCause::Pin, None)
    } else {
        (ResetCause::Other, None)
    };
    let restarts = if after.is_some() { kept(RESTARTS).saturating_add(1) } else { 0 };
    keep(RESTARTS, restarts);
    let stay_off = restarts > RESTARTS_MAX;
    Start { after: if stay_off { Some(Fault::TooManyRestarts) } else { after }, cause, stay_off }
}

/// The image has run for a while: what comes now is another story.
pub fn lived_well() {
    keep(RESTARTS, 0);
}

fn kept(place: usize) -> u32 {
    // SAFETY: an aligned word in it; whoever writes it is never interrupted by one who reads it, and any bits are a u32.
    unsafe { addr_of!(KEPT).cast::<u32>().add(place).read_volatile() }
}

fn keep(place: usize, word: u32) {
    // SAFETY: an aligned word in it, written whole.
    unsafe { addr_of_mut!(KEPT).cast::<u32>().add(place).write_volatile(word) }
}

/// The image can go on no longer, and this is why: the bridge off, the mark left, a reset.
pub fn give_up(mark: Mark, why: &str) -> ! {
    cortex_m::interrupt::disable();
    bridge::off();
    keep(MARK, mark as u32);
    black_box::why(why.as_bytes());
    SCB::sys_reset()
}

#[panic_handler]
fn on_panic(info: &PanicInfo) -> ! {
    cortex_m::interrupt::disable();
    bridge::off();
    defmt::error!("{}", defmt::Display2Format(info));
    if let Some(place) = info.location() {
        // The end of a path says most.
        let path = place.file().as_bytes();
        let from = path.iter().rposition(|&byte| byte == b'/').map_or(0, |at| at + 1);
        black_box::why(path.get(from..).unwrap_or(path));
        black_box::why(b":");
        black_box::why_decimal(place.line());
    }
    give_up(Mark::Panicked, "")
}

/// A fault of the core: as a panic.
///
/// # Safety
/// Called by the core only.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    cortex_m::interrupt::disable();
    bridge::off();
    black_box::why(b"hard fault at 0x");
    black_box::why_hex(frame.pc());
    give_up(Mark::Panicked, "")
}

/// The clock security system says that the crystal has stopped (RM0383, section 6.2.7): the chip runs on at 16 MHz, far too slow for
/// a tick, and nobody knows how long that lasts.
///
/// # Safety
/// Called by the core only.
#[exception]
unsafe fn NonMaskableInt() -> ! {
    give_up(Mark::CrystalLost, "")
}

/// An interrupt that nobody bound: as a panic.
///
/// # Safety
/// Called by the core only.
#[exception]
unsafe fn DefaultHandler(_irq: i16) -> ! {
    give_up(Mark::Panicked, "an interrupt that nobody bound")
}
