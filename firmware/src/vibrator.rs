//! The vibration motor of the feedback to the wearer: TIM4 channel 1 on PB6, 20 kHz, through a transistor.

use embassy_stm32::Peri;
use embassy_stm32::pac::gpio::vals::Moder;
use embassy_stm32::pac::timer::vals::Ocm;
use embassy_stm32::pac::{GPIOB, RCC, TIM4};
use embassy_stm32::peripherals::{self, PB6};
use tenax_hal_shim::motor::Duty;

/// Its pin, and the function of it that is the timer's (DS10314, table 9).
const PIN: usize = 6;
const TIM4_CH1: u8 = 2;
/// A period has as many ticks as a duty has per mille, each of five of the timer's at 100 MHz: no division, and above hearing.
const DIVIDED_BY: u16 = 5;

/// The motor. A reset leaves its pin floating, and the transistor's resistor switches it off.
pub struct Vibrator {
    _taken: (),
}

impl Vibrator {
    /// Takes timer and pin, which is low from here on.
    pub fn new(_timer: Peri<'static, peripherals::TIM4>, _pin: Peri<'static, PB6>) -> Self {
        RCC.apb1enr().modify(|w| w.set_tim4en(true));
        TIM4.psc().write_value(DIVIDED_BY - 1);
        TIM4.arr().write(|w| w.set_arr(Duty::FULL.as_per_mille() - 1));
        TIM4.ccmr_output(0).write(|w| {
            w.set_ocm(0, Ocm::PWM_MODE1);
            w.set_ocpe(0, true);
        });
        TIM4.ccer().write(|w| w.set_cce(0, true));
        TIM4.egr().write(|w| w.set_ug(true));
        TIM4.cr1().write(|w| w.set_cen(true));
        GPIOB.afr(0).modify(|w| w.set_afr(PIN, TIM4_CH1));
        GPIOB.moder().modify(|w| w.set_moder(PIN, Moder::ALTERNATE));
        Self { _taken: () }
    }

    pub fn drive(&mut self, duty: Duty) {
        TIM4.ccr(0).write(|w| w.set_ccr(duty.as_per_mille()));
    }
}

/// Stops it from anywhere: for a panic or a fault.
pub fn off() {
    TIM4.ccr(0).write(|w| w.set_ccr(0));
}
