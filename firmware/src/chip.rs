//! What differs between the chips that the image is compiled for. It runs on the STM32F411RE; the STM32F446RE is compiled only.
//!
//! Both have the same flash sectors and as much RAM (`memory.x`), and every peripheral in use under the same name but one.

/// The registers that the converters share.
#[cfg(feature = "stm32f411re")]
pub use embassy_stm32::pac::ADC1_COMMON as ADC_COMMON;
/// The registers that the converters share.
#[cfg(feature = "stm32f446re")]
pub use embassy_stm32::pac::ADC123_COMMON as ADC_COMMON;
