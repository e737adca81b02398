//! The independent watchdog: unless it is fed, it resets the chip. Its clock is its own.

use embassy_stm32::Peri;
use embassy_stm32::pac::IWDG;
use embassy_stm32::pac::iwdg::vals::{Key, Pr};
use embassy_stm32::peripherals;

/// Its period, ms. Control feeds it 200 times in one; nobody else does.
const PERIOD_MS: u16 = 100;
/// Its clock, 32 kHz (17 to 47, DS10314), divided by 4.
const TICKS_PER_MS: u16 = 8;

pub struct Watchdog {
    _taken: Peri<'static, peripherals::IWDG>,
}

impl Watchdog {
    pub fn new(taken: Peri<'static, peripherals::IWDG>) -> Self {
        IWDG.kr().write(|w| w.set_key(Key::ENABLE));
        IWDG.pr().write(|w| w.set_pr(Pr::DIVIDE_BY4));
        IWDG.rlr().write(|w| w.set_rl(PERIOD_MS * TICKS_PER_MS - 1));
        Self { _taken: taken }
    }

    pub fn start(&mut self) {
        IWDG.kr().write(|w| w.set_key(Key::START));
    }

    pub fn feed(&mut self) {
        IWDG.kr().write(|w| w.set_key(Key::RESET));
    }
}
