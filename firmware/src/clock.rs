//! The clock tree: 100 MHz from the ST-LINK's 8 MHz. Through the PAC: embassy's configuration has ways to panic.

use cortex_m::asm::{delay, dsb};
use embassy_stm32::pac::flash::vals::Latency;
use embassy_stm32::pac::pwr::vals::Vos;
use embassy_stm32::pac::rcc::vals::{Hpre, Pllm, Plln, Pllp, Pllsrc, Ppre, Sw};
use embassy_stm32::pac::{DBGMCU, FLASH, PWR, RCC};
use tenax_logic::restart::Mark;

use crate::last_words::give_up;

/// Clock of AHB and all timers, Hz (RM0383, figure 12): a scan period is a whole number of its ticks and of microseconds.
pub const CORE_HZ: u32 = 100_000_000;
pub const APB1_HZ: u32 = CORE_HZ / 2;

/// Switches on the clocks of all that the image uses. They take two cycles to come (ES0287, delay after an RCC peripheral clock enabling).
pub fn enable() {
    RCC.ahb1enr().modify(|w| {
        w.set_gpioaen(true);
        w.set_gpioben(true);
        w.set_gpiocen(true);
        w.set_dma1en(true);
        w.set_dma2en(true);
    });
    RCC.apb1enr().modify(|w| {
        w.set_pwren(true);
        w.set_tim2en(true);
        w.set_tim3en(true);
        w.set_tim4en(true);
        w.set_usart2en(true);
    });
    RCC.apb2enr().modify(|w| {
        w.set_adc1en(true);
        w.set_tim1en(true);
    });
    dsb();
}

/// For a supply above 2.7 V: three wait states at 100 MHz (RM0383, table 5). Lets the flash fetch ahead and cache instructions, or the chip pays
/// them at every jump (section 3.4). Its data cache stays off, so that what was programmed is what is read.
pub fn accelerate_flash() {
    FLASH.acr().modify(|acr| {
        acr.set_latency(Latency::WS3);
        acr.set_prften(true);
        acr.set_icen(true);
    });
}

/// One look at the crystal, 0.1 ms at 16 MHz.
pub const LOOK_CYCLES: u32 = 1_600;
pub const LOOKS_PER_S: u32 = 10_000;
/// A crystal takes 2 ms (DS10314, HSE oscillator characteristics), the ST-LINK's clock goes on through a reset: 20 ms. Where the supply
/// has been off, the ST-LINK starts as well: 0.3 s.
const LOOKS: u32 = 200;
const LOOKS_SUPPLIED: u32 = 3_000;

pub fn has_crystal(was_off: bool) -> bool {
    RCC.cr().modify(|w| {
        w.set_hsebyp(true);
        w.set_hseon(true);
    });
    comes_within(if was_off { LOOKS_SUPPLIED } else { LOOKS }, || RCC.cr().read().hserdy())
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

/// Whether the PLL locks, which takes it 0.3 ms at most (DS10314, main PLL characteristics): 2 MHz from either, times 50.
fn locks(on_crystal: bool) -> bool {
    // Its factors can be written while it is off.
    RCC.cr().modify(|w| {
        w.set_pllon(false);
        w.set_hseon(on_crystal);
    });
    RCC.pllcfgr().modify(|w| {
        w.set_pllm(if on_crystal { Pllm::DIV4 } else { Pllm::DIV8 });
        w.set_plln(Plln::MUL100);
        w.set_pllp(Pllp::DIV2);
        w.set_pllsrc(if on_crystal { Pllsrc::HSE } else { Pllsrc::HSI });
    });
    RCC.cr().modify(|w| w.set_pllon(true));
    comes_within(LOOKS, || RCC.cr().read().pllrdy())
}

/// Lets the chip say when the crystal stops: to the handler of the non-maskable interrupt.
pub fn watch_crystal() {
    RCC.cr().modify(|w| w.set_csson(true));
}

/// Starts the clocks, out of a reset: HSE bypassed at 8 MHz, PLL to 100 MHz, AHB at 100 MHz, APB1 at 50, APB2 at 100; with wait states for
/// any supply. HSI only where there is no crystal: its tolerance overruns the serial line at 921 600
/// baud, but a hand that nobody hears is better than one that nobody can open. True: they run on the crystal.
pub fn start(crystal: bool) -> bool {
    // A debugger is heard while the core sleeps.
    DBGMCU.cr().modify(|w| {
        w.set_dbg_sleep(true);
        w.set_dbg_stop(true);
        w.set_dbg_standby(true);
    });
    PWR.cr1().modify(|w| w.set_vos(Vos::SCALE1));
    let crystal = crystal && locks(true);
    if !crystal && !locks(false) {
        give_up(Mark::Panicked, "the PLL does not lock");
    }
    FLASH.acr().write(|w| w.set_latency(Latency::WS6));
    if !comes_within(LOOKS, || FLASH.acr().read().latency() == Latency::WS6) {
        give_up(Mark::Panicked, "the flash keeps its wait states");
    }
    RCC.cfgr().modify(|w| {
        w.set_sw(Sw::PLL1_P);
        w.set_hpre(Hpre::DIV1);
        w.set_ppre1(Ppre::DIV2);
        w.set_ppre2(Ppre::DIV1);
    });
    if !comes_within(LOOKS, || RCC.cfgr().read().sws() == Sw::PLL1_P) {
        give_up(Mark::Panicked, "the clock does not switch");
    }
    if crystal {
        RCC.cr().modify(|w| w.set_hsion(false));
    }
    crystal
}
