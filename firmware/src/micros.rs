//! TIM2 counts microseconds in 32 bits: the clock of the scan and of every deadline.

use embassy_stm32::pac::{RCC, TIM2};

use crate::clock::CORE_HZ;

/// Starts the clock at zero.
pub fn start() {
    RCC.apb1enr().modify(|w| w.set_tim2en(true));
    TIM2.arr().write_value(u32::MAX);
    TIM2.psc().write_value((CORE_HZ / 1_000_000 - 1) as u16);
    // The update takes the prescaler up.
    TIM2.egr().write(|w| w.set_ug(true));
    TIM2.cr1().write(|w| w.set_cen(true));
}

/// The clock, us, for whoever compares two instants of the same half hour.
pub fn clock_us() -> u32 {
    TIM2.cnt().read()
}
