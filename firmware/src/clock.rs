//! The clock tree: 100 MHz from the ST-LINK's 8 MHz.

use embassy_stm32::rcc::{
    AHBPrescaler, APBPrescaler, Hse, HseMode, Pll, PllMul, PllPDiv, PllPreDiv, PllSource, Sysclk,
};
use embassy_stm32::time::Hertz;
use embassy_stm32::{Config, pac};

/// Lets the flash fetch ahead and cache instructions: at 100 MHz it has three wait states, which the chip otherwise pays
/// at every jump (RM0383, section 3.4). Its data cache stays off, so that what was programmed is what is read.
pub fn accelerate_flash() {
    pac::FLASH.acr().modify(|acr| {
        acr.set_prften(true);
        acr.set_icen(true);
    });
}

/// Crystal start: the ST-LINK's clock is there within milliseconds of its own start. Loops of some cycles at 16 MHz: about 0.3 s.
const CRYSTAL_LOOPS: u32 = 1_000_000;

/// Whether the crystal's clock comes. Asked before anything waits for it without an end.
pub fn has_crystal() -> bool {
    pac::RCC.cr().modify(|w| {
        w.set_hsebyp(true);
        w.set_hseon(true);
    });
    (0..CRYSTAL_LOOPS).any(|_| pac::RCC.cr().read().hserdy())
}

/// Lets the chip say when the crystal stops: to the handler of the non-maskable interrupt.
pub fn watch_crystal() {
    pac::RCC.cr().modify(|w| w.set_csson(true));
}

/// The chip's configuration: HSE bypassed at 8 MHz, PLL to 100 MHz, AHB and APB2 at 100 MHz, APB1 at 50 MHz.
///
/// HSI only where there is no crystal: its tolerance overruns the serial line at 921 600 baud, but a hand that nobody hears is
/// better than one that nobody can open. Timers on APB1 count at 100 MHz as well (RM0383, figure 12), so a scan period is a
/// whole number of their ticks and of the time driver's microseconds.
pub fn config(crystal: bool) -> Config {
    let mut config = Config::default();
    config.rcc.hsi = !crystal;
    config.rcc.hse = crystal.then_some(Hse { freq: Hertz(8_000_000), mode: HseMode::Bypass });
    config.rcc.pll_src = if crystal { PllSource::HSE } else { PllSource::HSI };
    config.rcc.pll = Some(Pll {
        // 2 MHz from either.
        prediv: if crystal { PllPreDiv::DIV4 } else { PllPreDiv::DIV8 },
        mul: PllMul::MUL100,
        divp: Some(PllPDiv::DIV2),
        divq: None,
        divr: None,
    });
    config.rcc.sys = Sysclk::PLL1_P;
    config.rcc.ahb_pre = AHBPrescaler::DIV1;
    config.rcc.apb1_pre = APBPrescaler::DIV2;
    config.rcc.apb2_pre = APBPrescaler::DIV1;
    config
}
