//! What differs between the chips that the image is made for: the STM32F411RE of the board, and the STM32F446RE, which is emulated only.
//!
//! Both have the same flash sectors and as much RAM (`memory.x`), and every peripheral in use at the same address. Both run at 100 MHz,
//! the timers too; but the F446's peripherals bear 90 and 45 MHz (DS10693, general operating conditions), so theirs run at 50 and 25.
//! Its USART1 has no pin left to send on: PA9 drives the bridge, PB6 the vibration motor, and on PA15 it has none (DS10693,
//! alternate functions).
//! So it has no palm's bus and speaks on CAN instead (`can.rs`), which the F411 has not.

#[cfg(feature = "stm32f411re")]
mod numbers {
    pub use embassy_stm32::pac::ADC1_COMMON as ADC_COMMON;
    use embassy_stm32::pac::adccommon::vals::Adcpre;
    use embassy_stm32::pac::rcc::vals::Ppre;

    /// What divides the core's clock for APB1 and for APB2.
    pub const APB: [Ppre; 2] = [Ppre::DIV2, Ppre::DIV1];
    /// Of APB1, over the core's.
    pub const APB1_DIVIDER: u32 = 2;
    /// What divides APB2's clock to the converters' 25 MHz.
    pub const ADC: Adcpre = Adcpre::DIV4;

    /// The timers run at the core's clock in any case.
    pub fn speed_timers_up() {}
}

#[cfg(feature = "stm32f446re")]
mod numbers {
    pub use embassy_stm32::pac::ADC123_COMMON as ADC_COMMON;
    use embassy_stm32::pac::RCC;
    use embassy_stm32::pac::adccommon::vals::Adcpre;
    use embassy_stm32::pac::rcc::vals::{Ppre, Timpre};

    /// What divides the core's clock for APB1 and for APB2.
    pub const APB: [Ppre; 2] = [Ppre::DIV4, Ppre::DIV2];
    /// Of APB1, over the core's.
    pub const APB1_DIVIDER: u32 = 4;
    /// What divides APB2's clock to the converters' 25 MHz.
    pub const ADC: Adcpre = Adcpre::DIV2;

    /// Lets the timers run at the core's clock, however the buses are divided (RM0390, RCC dedicated clocks configuration register).
    pub fn speed_timers_up() {
        RCC.dckcfgr().modify(|w| w.set_timpre(Timpre::MUL4));
    }
}

pub use numbers::*;
