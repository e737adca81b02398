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

/// The chip's configuration: HSE bypassed at 8 MHz, PLL to 100 MHz, AHB and APB2 at 100 MHz, APB1 at 50 MHz.
///
/// Never HSI: its tolerance overruns the serial line at 921 600 baud. Timers on APB1 count at 100 MHz as well (RM0383,
/// figure 12), so a scan period is a whole number of their ticks and of the time driver's microseconds.
pub fn config() -> Config {
    let mut config = Config::default();
    config.rcc.hsi = false;
    config.rcc.hse = Some(Hse { freq: Hertz(8_000_000), mode: HseMode::Bypass });
    config.rcc.pll_src = PllSource::HSE;
    config.rcc.pll = Some(Pll {
        prediv: PllPreDiv::DIV4,
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
