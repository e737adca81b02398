//! The supply: judged before anything is fast, and while it sags the bridge is off.
//!
//! Two guards of the chip (DS10314, embedded reset and power control block; typical figures). The voltage detector at level 6
//! (RM0383, section 5.2.3) says that the supply falls below 2.93 V: the bridge goes off and the chip is reset while code still
//! runs as it should. Level 7 would be 3.03 V falling and 3.14 V rising: a dip of 0.25 V that harms nothing would let go of the
//! motor, and a rail of 3.1 V would never start. The brown-out reset at level 3 holds the chip from 2.83 V on.
//! Its handler is above all (0). Owns PWR and EXTI's line 16. Only reads the option bytes. embassy-stm32 0.6.0 has a driver of none of them.

use cortex_m::asm::delay;
use embassy_stm32::interrupt;
use embassy_stm32::interrupt::InterruptExt;
use embassy_stm32::pac::{EXTI, FLASH, PWR};
use tenax_logic::restart::Mark;

use crate::last_words;
use crate::timing::{LOOK_CYCLES, SUPPLY_LOOKS};

/// PLS: 2.93 V falling, 3.03 V rising.
const LEVEL_6: u8 = 6;
/// The line of the voltage detector's output among the external interrupts (RM0383, section 10.2.5).
const LINE: usize = 16;
/// BOR_LEV: reset below 2.83 V.
const BROWN_OUT_LEVEL_3: u8 = 0;

/// Waits for the supply to rise, at 16 MHz, which any supply carries; 1 s at most: a battery behind a regulator takes some ms. False: it is
/// too low, and nothing may be programmed.
#[must_use]
pub fn has_risen() -> bool {
    PWR.cr1().modify(|w| {
        w.set_pls(LEVEL_6);
        w.set_pvde(true);
    });
    (0..SUPPLY_LOOKS).any(|_| {
        // The detector itself needs some microseconds to start.
        delay(LOOK_CYCLES);
        !is_low()
    })
}

/// Watches the supply from now on.
pub fn watch() {
    EXTI.rtsr(0).modify(|w| w.set_line(LINE, true));
    EXTI.pr(0).write(|w| w.set_line(LINE, true));
    EXTI.imr(0).modify(|w| w.set_line(LINE, true));
    // SAFETY: its handler touches nothing that anybody else uses.
    unsafe { interrupt::PVD.enable() };
    // Its edge may have come before the line was cleared.
    if is_low() {
        last_words::give_up(Mark::SupplySagged, "");
    }
}

pub fn is_low() -> bool {
    PWR.csr1().read().pvdo()
}

#[interrupt]
unsafe fn PVD() {
    last_words::give_up(Mark::SupplySagged, "")
}

/// Whether the brown-out reset holds the chip below 2.83 V. It is an option byte, and the image programs none: a power cut meanwhile can leave
/// every sector protected.
pub fn has_brown_out_reset() -> bool {
    FLASH.optcr().read().bor_lev() == BROWN_OUT_LEVEL_3
}
