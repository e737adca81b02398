//! The blue button of the NUCLEO (B1, UM1724 section 6.5): somebody at the hand consents to what the serial line sends.

use embassy_stm32::Peri;
use embassy_stm32::gpio::{Input, Pull};
use embassy_stm32::peripherals::PC13;

/// The button. It pulls its pin low.
pub struct Button(Input<'static>);

impl Button {
    /// Takes the pin. The board has a pull-up of its own; where there is none, no button is a released one.
    pub fn new(pin: Peri<'static, PC13>) -> Self {
        Self(Input::new(pin, Pull::Up))
    }

    /// Whether it is down. It may bounce: the logic waits until it does not.
    pub fn is_down(&self) -> bool {
        self.0.is_low()
    }
}
