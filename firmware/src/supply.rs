//! The supply: while it sags, the bridge is off.
//!
//! Two guards of the chip. The voltage detector (RM0383, section 5.2.2) says that the supply falls below 2.9 V: the bridge goes
//! off and the chip is reset while code still runs as it should. The brown-out reset holds the chip from 2.7 V on; its level
//! is an option byte, which a chip from the factory has off, and which is programmed once.

use embassy_stm32::interrupt;
use embassy_stm32::interrupt::{InterruptExt, Priority};
use embassy_stm32::pac::{EXTI, FLASH, PWR, RCC};
use embassy_time::{Duration, Instant};

use crate::last_words::{self, Mark};

/// PLS: 2.9 V, the highest threshold (DS10314, embedded reset and power control).
const THRESHOLD_2_9_V: u8 = 7;
/// The line of the voltage detector's output among the external interrupts (RM0383, section 10.2.5).
const LINE: usize = 16;
/// BOR_LEV: reset below 2.7 V (level 3), and off.
const BROWN_OUT_2_7_V: u8 = 0;
/// RM0383, section 3.6.2.
const OPTION_KEYS: [u32; 2] = [0x0819_2A3B, 0x4C5D_6E7F];
/// Longer than the option bytes take (DS10314, flash memory programming).
const PATIENCE: Duration = Duration::from_secs(4);

/// Waits until the supply is there, and watches it from then on. Nothing moves meanwhile.
pub fn watch() {
    RCC.apb1enr().modify(|w| w.set_pwren(true));
    PWR.cr1().modify(|w| {
        w.set_pls(THRESHOLD_2_9_V);
        w.set_pvde(true);
    });
    while PWR.csr1().read().pvdo() {}
    EXTI.rtsr(0).modify(|w| w.set_line(LINE, true));
    EXTI.pr(0).write(|w| w.set_line(LINE, true));
    EXTI.imr(0).modify(|w| w.set_line(LINE, true));
    interrupt::PVD.set_priority(Priority::P0);
    // SAFETY: its handler touches nothing that anybody else uses.
    unsafe { interrupt::PVD.enable() };
}

/// The supply sags.
#[interrupt]
unsafe fn PVD() {
    last_words::give_up(Mark::SupplySagged, "")
}

/// Sees to it that the brown-out reset is on. Only where somebody has just switched the hand on: it may take a second.
pub fn hold_in_reset_when_too_low() {
    if FLASH.optcr().read().bor_lev() == BROWN_OUT_2_7_V {
        return;
    }
    for key in OPTION_KEYS {
        FLASH.optkeyr().write_value(key);
    }
    FLASH.optcr().modify(|w| w.set_bor_lev(BROWN_OUT_2_7_V));
    FLASH.optcr().modify(|w| w.set_optstrt(true));
    let deadline = Instant::now() + PATIENCE;
    while FLASH.sr().read().bsy() && Instant::now() < deadline {}
    FLASH.optcr().modify(|w| w.set_optlock(true));
}
