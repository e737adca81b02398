//! The blue button of the NUCLEO (B1, UM1724 section 6.5), and a light: what somebody at the hand has without a PC.

use embassy_stm32::Peri;
use embassy_stm32::gpio::{Input, Level, Output, Pull, Speed};
use embassy_stm32::peripherals::{PC6, PC8, PC13};

/// The button, which pulls its pin low, and an LED with its resistor from its pin to ground. The NUCLEO's own LED is on a
/// film's pin. Beside them the bridge's nFAULT, which is open drain and pulled low (DRV8874, section 7.3.4): not wired, it is high.
pub struct Button {
    pin: Input<'static>,
    light: Output<'static>,
    bridge_fault: Input<'static>,
}

impl Button {
    /// Takes the pins. The board has a pull-up of its own; where there is none, no button is a released one.
    pub fn new(
        pin: Peri<'static, PC13>,
        light: Peri<'static, PC6>,
        bridge_fault: Peri<'static, PC8>,
    ) -> Self {
        Self {
            pin: Input::new(pin, Pull::Up),
            light: Output::new(light, Level::Low, Speed::Low),
            bridge_fault: Input::new(bridge_fault, Pull::Up),
        }
    }

    pub fn bridge_is_off(&self) -> bool {
        self.bridge_fault.is_low()
    }

    /// Whether it is down. It may bounce: the logic waits until it does not.
    pub fn is_down(&self) -> bool {
        self.pin.is_low()
    }

    pub fn light(&mut self, on: bool) {
        self.light.set_level(Level::from(on));
    }
}
