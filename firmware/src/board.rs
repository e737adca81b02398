//! The small parts of the board that control drives: button and light, select lines, vibration motor.

use embassy_stm32::Peri;
use embassy_stm32::gpio::{AnyPin, Input, Level, Output, Pull, Speed};
use embassy_stm32::pac::gpio::vals::Moder;
use embassy_stm32::pac::timer::vals::Ocm;
use embassy_stm32::pac::{GPIOB, TIM4};
use embassy_stm32::peripherals::{self, PB6, PC6, PC8, PC13};
use tenax_hal_shim::motor::Duty;

/// The blue button of the NUCLEO (B1, UM1724 section 6.5), which pulls its pin low, and an LED with its resistor from its pin to ground. The NUCLEO's own LED is on a
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

/// The first select line's pin: S0 to S3 are PB12 to PB15.
const FIRST_PIN: usize = 12;

/// The select lines of the two analogue switches.
pub struct Switches {
    _lines: [Output<'static>; 4],
}

impl Switches {
    pub fn new(lines: [Peri<'static, AnyPin>; 4]) -> Self {
        // Slow edges: they must not be heard on the films, and the switches have most of 87 us to settle.
        Self { _lines: lines.map(|line| Output::new(line, Level::Low, Speed::Low)) }
    }

    /// Shows `select`, 0 to 15. All four lines step together: no other input is passed through on the way.
    pub fn show(&mut self, select: u8) {
        GPIOB.bsrr().write(|w| {
            for line in 0..4 {
                let pin = FIRST_PIN + line;
                if select >> line & 1 == 1 {
                    w.set_bs(pin, true);
                } else {
                    w.set_br(pin, true);
                }
            }
        });
    }
}

/// The vibration motor's pin, and the function of it that is the timer's (DS10314, table 9).
const VIBRATOR_PIN: usize = 6;
const TIM4_CH1: u8 = 2;
/// A period has as many ticks as a duty has per mille, each of five of the timer's at 100 MHz: no division, and above hearing.
const DIVIDED_BY: u16 = 5;

/// The vibration motor of the feedback to the wearer: TIM4 channel 1, 20 kHz, through a transistor. A reset leaves its pin floating, and the transistor's resistor switches it off.
pub struct Vibrator {
    _taken: (),
}

impl Vibrator {
    pub fn new(_timer: Peri<'static, peripherals::TIM4>, _pin: Peri<'static, PB6>) -> Self {
        TIM4.psc().write_value(DIVIDED_BY - 1);
        TIM4.arr().write(|w| w.set_arr(Duty::FULL.as_per_mille() - 1));
        TIM4.ccmr_output(0).write(|w| {
            w.set_ocm(0, Ocm::PWM_MODE1);
            w.set_ocpe(0, true);
        });
        TIM4.ccer().write(|w| w.set_cce(0, true));
        TIM4.egr().write(|w| w.set_ug(true));
        TIM4.cr1().write(|w| w.set_cen(true));
        GPIOB.afr(0).modify(|w| w.set_afr(VIBRATOR_PIN, TIM4_CH1));
        GPIOB.moder().modify(|w| w.set_moder(VIBRATOR_PIN, Moder::ALTERNATE));
        Self { _taken: () }
    }

    pub fn drive(&mut self, duty: Duty) {
        TIM4.ccr(0).write(|w| w.set_ccr(duty.as_per_mille()));
    }
}

pub fn vibrator_off() {
    TIM4.ccr(0).write(|w| w.set_ccr(0));
}
