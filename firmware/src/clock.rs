//! The clock tree: 100 MHz from the ST-LINK's 8 MHz, set by embassy, whose code waits without end for a crystal or a PLL that never comes
//! (embassy-stm32 0.6.0, `rcc/f247.rs`). So both are tried here first, each wait with an end; what is ready then is ready for embassy,
//! and the watchdog, which runs before, ends what is not.
//! embassy enables each peripheral's clock, too, and waits by a DSB (ES0287, delay after an RCC peripheral clock enabling).
//! Runs at the start, before any interrupt is on. Owns RCC. Never waits without an end.

use cortex_m::asm::delay;
use embassy_stm32::Peri;
use embassy_stm32::pac::rcc::vals::{Pllm, Plln, Pllp, Pllsrc};
use embassy_stm32::pac::{FLASH, RCC};
use embassy_stm32::rcc::{
    self, AHBPrescaler, APBPrescaler, Hse, HseMode, LsConfig, Pll, PllMul, PllPDiv, PllPreDiv, PllSource,
    Sysclk,
};
use embassy_stm32::time::Hertz;
use embassy_stm32::{Config, peripherals};
use tenax_logic::restart::Mark;

use crate::last_words::give_up;
use crate::timing::{CRYSTAL_LOOKS, LOOK_CYCLES, LOOKS};

const CRYSTAL: Hse = Hse { freq: Hertz(8_000_000), mode: HseMode::Bypass };

/// The first configuration, of a chip that was reset: it runs on at 16 MHz, which any supply carries and nothing is waited for.
pub fn slow() -> Config {
    let mut config = Config::default();
    config.rcc.ls = LsConfig::off();
    config
}

/// HSE bypassed at 8 MHz, PLL to 100 MHz, AHB at 100 MHz, APB1 at 50, APB2 at 100.
fn fast(on_crystal: bool) -> rcc::Config {
    let mut config = slow().rcc;
    config.hsi = !on_crystal;
    config.hse = on_crystal.then_some(CRYSTAL);
    config.pll_src = if on_crystal { PllSource::HSE } else { PllSource::HSI };
    let prediv = if on_crystal { PllPreDiv::DIV4 } else { PllPreDiv::DIV8 };
    let (mul, divp) = (PllMul::MUL100, Some(PllPDiv::DIV2));
    config.pll = Some(Pll { prediv, mul, divp, divq: None, divr: None });
    config.sys = Sysclk::PLL1_P;
    (config.ahb_pre, config.apb1_pre, config.apb2_pre) =
        (AHBPrescaler::DIV1, APBPrescaler::DIV2, APBPrescaler::DIV1);
    config
}

fn has_crystal(was_off: bool) -> bool {
    RCC.cr().modify(|w| {
        w.set_hsebyp(true);
        w.set_hseon(true);
    });
    comes_within(if was_off { CRYSTAL_LOOKS } else { LOOKS }, || RCC.cr().read().hserdy())
}

fn comes_within(looks: u32, is_there: impl Fn() -> bool) -> bool {
    (0..looks).any(|_| {
        let is_there = is_there();
        if !is_there {
            delay(LOOK_CYCLES);
        }
        is_there
    })
}

/// Whether the PLL locks, which takes it 0.3 ms at most (DS10314, main PLL characteristics): 2 MHz from either, times 50. It is off again
/// afterwards: its factors and the core's voltage can be set while it is.
fn locks(on_crystal: bool) -> bool {
    RCC.pllcfgr().modify(|w| {
        w.set_pllm(if on_crystal { Pllm::DIV4 } else { Pllm::DIV8 });
        w.set_plln(Plln::MUL100);
        w.set_pllp(Pllp::DIV2);
        w.set_pllsrc(if on_crystal { Pllsrc::HSE } else { Pllsrc::HSI });
    });
    RCC.cr().modify(|w| w.set_pllon(true));
    let locked = comes_within(LOOKS, || RCC.cr().read().pllrdy());
    RCC.cr().modify(|w| w.set_pllon(false));
    locked && comes_within(LOOKS, || !RCC.cr().read().pllrdy())
}

/// Starts the clocks for a supply above 2.7 V: three wait states at 100 MHz (RM0383, table 5). HSI only where there is no crystal: its
/// tolerance overruns the serial line at 921 600 baud, but a hand that nobody hears is better than one that nobody can open. True: they
/// run on the crystal.
pub fn start(was_off: bool, clocks: &mut Peri<'static, peripherals::RCC>) -> bool {
    let crystal = has_crystal(was_off) && locks(true);
    if !crystal && !locks(false) {
        give_up(Mark::Panicked, "the PLL does not lock");
    }
    rcc::reinit(fast(crystal), clocks);
    // The flash fetches ahead and caches instructions, or the chip pays the wait states at every jump (section 3.4). Its data cache stays
    // off, so that what was programmed is what is read.
    FLASH.acr().modify(|acr| {
        acr.set_prften(true);
        acr.set_icen(true);
    });
    if crystal {
        // The chip says when it stops: to the handler of the non-maskable interrupt.
        RCC.cr().modify(|w| w.set_csson(true));
    }
    crystal
}
