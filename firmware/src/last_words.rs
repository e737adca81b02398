//! The end of a run by a fault: the bridge goes off first, then a mark is left in RAM, which a reset does not clear, and the chip is
//! reset. And a guard under the stack, whose fault is one of them.
//! Runs in whoever fails, all interrupts off. Owns its words in RAM, and the MPU. Never waits, never uses the line or RTT.

use core::mem::MaybeUninit;
use core::ptr::{addr_of, addr_of_mut};

use cortex_m::asm::{dsb, isb};
use cortex_m::peripheral::{MPU, SCB};
use cortex_m_rt::{ExceptionFrame, exception};
use embassy_stm32::pac;
use tenax_logic::restart::{self, Flags, Mark, Start};

use crate::{black_box, board, bridge};

/// Marks of the end of a run, as words in RAM; any other word is RAM after power-on.
const MARKS: [(Mark, u32); 3] =
    [(Mark::Panicked, 0x7E4A_C0DE), (Mark::SupplySagged, 0x7E4A_BA77), (Mark::CrystalLost, 0x7E4A_C10C)];

/// Not initialised by the runtime: a reset leaves it as it is.
#[unsafe(link_section = ".uninit.mark")]
static mut MARK_AND_RESTARTS: MaybeUninit<[u32; 2]> = MaybeUninit::uninit();
const MARK: usize = 0;
const RESTARTS: usize = 1;

/// The cause of this start, from RCC: embassy-stm32 0.6.0 tells none. Called once, first: it clears flags and mark.
pub fn start() -> Start {
    let csr = pac::RCC.csr().read();
    pac::RCC.csr().modify(|w| w.set_rmvf(true));
    let flags = Flags {
        power_on: csr.porrstf(),
        brown_out: csr.borrstf(),
        watchdog: csr.wdgrstf(),
        software: csr.sftrstf(),
        pin: csr.padrstf(),
    };
    let word = kept(MARK);
    keep(MARK, 0);
    let mark = MARKS.iter().find(|(_, own)| *own == word).map(|(mark, _)| *mark);
    let start = restart::judge(flags, mark, kept(RESTARTS));
    keep(RESTARTS, start.restarts);
    start
}

pub fn lived_well() {
    keep(RESTARTS, 0);
}

fn kept(place: usize) -> u32 {
    // SAFETY: an aligned word in it; whoever writes it is never interrupted by one who reads it, and any bits are a u32.
    unsafe { addr_of!(MARK_AND_RESTARTS).cast::<u32>().add(place).read_volatile() }
}

fn keep(place: usize, word: u32) {
    // SAFETY: an aligned word in it, written whole.
    unsafe { addr_of_mut!(MARK_AND_RESTARTS).cast::<u32>().add(place).write_volatile(word) }
}

/// Switches the bridge off, leaves the mark and the reason, and resets the chip.
pub fn give_up(mark: Mark, why: &str) -> ! {
    leave(mark, why);
    SCB::sys_reset()
}

/// Switches the bridge off, leaves the mark and the reason, with all interrupts off from now on.
pub fn leave(mark: Mark, why: &str) {
    cortex_m::interrupt::disable();
    bridge::off();
    board::vibrator_off();
    if let Some((_, word)) = MARKS.iter().find(|(own, _)| *own == mark) {
        keep(MARK, *word);
    }
    black_box::why(why.as_bytes());
}

/// A fault of the core: as a panic. Its reason is PC, LR, CFSR, HFSR and BFAR (ARM DDI 0403E, section B3.2).
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    leave(Mark::Panicked, "HF");
    // SAFETY: reading these registers changes nothing.
    let scb = unsafe { &*SCB::PTR };
    for word in [frame.pc(), frame.lr(), scb.cfsr.read(), scb.hfsr.read(), scb.bfar.read()] {
        black_box::why(b" ");
        black_box::why_hex(word);
    }
    SCB::sys_reset()
}

/// The clock security system says that the crystal has stopped (RM0383, section 6.2.7): the chip runs on at 16 MHz, far too slow for
/// a tick, and nobody knows how long that lasts.
#[exception]
unsafe fn NonMaskableInt() -> ! {
    give_up(Mark::CrystalLost, "")
}

/// An interrupt that nobody bound: as a panic.
#[exception]
unsafe fn DefaultHandler(_irq: i16) -> ! {
    give_up(Mark::Panicked, "an interrupt that nobody bound")
}

unsafe extern "C" {
    /// The end of what is not initialised (cortex-m-rt's `link.x`): from here on there is only stack.
    static __euninit: u32;
}

/// More than most functions take at once, 2 KiB; a region begins at a multiple of its size.
const GUARD: u32 = 1 << GUARD_BITS;
const GUARD_BITS: u32 = 11;
/// RASR (ARM DDI 0403E, section B3.5.9): nothing may be executed, read or written, of this size, enabled.
const NO_ACCESS: u32 = 1 << 28 | (GUARD_BITS - 1) << 1 | 1;
/// CTRL (section B3.5.5): everything else as without it; not in the handler of a fault, which needs a stack.
const ENABLED: u32 = 1 << 2 | 1;

/// Switches the guard under the stack on: what overflows is a hard fault, and does not eat the black box, which lies below.
pub fn guard_stack() {
    let base = (addr_of!(__euninit) as u32 + GUARD - 1) & !(GUARD - 1);
    // SAFETY: nobody uses these bytes but a stack that overflows, and nobody else sets a region.
    unsafe {
        let mpu = &*MPU::PTR;
        mpu.rnr.write(0);
        mpu.rbar.write(base);
        mpu.rasr.write(NO_ACCESS);
        mpu.ctrl.write(ENABLED);
    }
    dsb();
    isb();
}
