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

use crate::bridge;

/// What the mark is when it was left by a panic or a fault. Any other value is what RAM held at power-on.
const PANICKED: u32 = 0x7E4A_C0DE;

/// Not initialised by the runtime, so it outlives a reset.
#[unsafe(link_section = ".uninit.mark")]
static mut MARK: MaybeUninit<u32> = MaybeUninit::uninit();

/// How this run began.
pub struct Start {
    /// Why the last run ended, if not by switching off.
    pub after: Option<Fault>,
    /// Why the chip started.
    pub cause: ResetCause,
}

/// How this run began. Asked once, before anything else is set up: it forgets the answer.
pub fn start() -> Start {
    let csr = pac::RCC.csr().read();
    pac::RCC.csr().modify(|w| w.set_rmvf(true));
    // SAFETY: nothing runs yet that could write the mark at the same time, and any bits are a u32.
    let mark = unsafe { addr_of!(MARK).cast::<u32>().read_volatile() };
    set_mark(0);
    let cause = if csr.porrstf() {
        ResetCause::PowerOn
    } else if csr.wdgrstf() {
        ResetCause::Watchdog
    } else if csr.sftrstf() {
        if mark == PANICKED { ResetCause::Panic } else { ResetCause::Software }
    } else if csr.padrstf() {
        ResetCause::Pin
    } else {
        ResetCause::Other
    };
    let after = match cause {
        ResetCause::Watchdog => Some(Fault::WatchdogReset),
        ResetCause::Panic => Some(Fault::PanicReset),
        _ => None,
    };
    Start { after, cause }
}

fn set_mark(mark: u32) {
    // SAFETY: called at start-up and with interrupts off, so never twice at a time.
    unsafe { addr_of_mut!(MARK).cast::<u32>().write_volatile(mark) }
}

/// The image can go on no longer: as a panic, without a word about it.
pub fn give_up() -> ! {
    cortex_m::interrupt::disable();
    bridge::off();
    set_mark(PANICKED);
    SCB::sys_reset()
}

#[panic_handler]
fn on_panic(info: &PanicInfo) -> ! {
    cortex_m::interrupt::disable();
    bridge::off();
    defmt::error!("{}", defmt::Display2Format(info));
    give_up()
}

/// A fault of the core: as a panic.
///
/// # Safety
/// Called by the core only.
#[exception]
unsafe fn HardFault(_frame: &ExceptionFrame) -> ! {
    give_up()
}

/// An interrupt that nobody bound: as a panic.
///
/// # Safety
/// Called by the core only.
#[exception]
unsafe fn DefaultHandler(_irq: i16) -> ! {
    give_up()
}
