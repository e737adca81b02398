//! The small parts of the board that control drives: button and light, select lines, vibration motor.
//! Runs in control (2). Owns GPIOB 12 to 15, PC6, PC8, PC13, TIM4 with PB6. Never panics, never waits.

use embassy_stm32::Peri;
use embassy_stm32::gpio::{AnyPin, Input, Level, Output, OutputType, Pull, Speed};
use embassy_stm32::pac::{GPIOB, TIM4};
use embassy_stm32::peripherals::{self, PB6, PC6, PC8, PC13};
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::low_level::CountingMode;
use embassy_stm32::timer::simple_pwm::{PwmPin, PwmPinConfig, SimplePwm, SimplePwmChannel};
use tenax_hal_shim::motor::Duty;

use crate::timing::{PWM_HZ, TICKS_PER_MILLE};

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

    /// Shows `select`, 0 to 15. All four lines step together, with one store, which embassy's pins do not offer: no other input is passed
    /// through on the way.
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

/// The vibration motor of the feedback to the wearer: TIM4 channel 1 through a transistor. A reset leaves its pin floating, and the transistor's resistor switches it off.
pub struct Vibrator {
    _channel: SimplePwmChannel<'static, peripherals::TIM4>,
}

impl Vibrator {
    pub fn new(timer: Peri<'static, peripherals::TIM4>, pin: Peri<'static, PB6>) -> Self {
        let slow = PwmPinConfig { output_type: OutputType::PushPull, speed: Speed::Low, pull: Pull::None };
        let pin = Some(PwmPin::new_with_config(pin, slow));
        let pwm = SimplePwm::new(timer, pin, None, None, None, Hertz(PWM_HZ), CountingMode::EdgeAlignedUp);
        let mut channel = pwm.split().ch1;
        channel.enable();
        Self { _channel: channel }
    }

    /// Not through the channel: its `set_duty_cycle` has two ways to panic, and this is control's.
    pub fn drive(&mut self, duty: Duty) {
        TIM4.ccr(0).write(|w| w.set_ccr(duty.as_per_mille() * TICKS_PER_MILLE));
    }
}

pub fn vibrator_off() {
    TIM4.ccr(0).write(|w| w.set_ccr(0));
}
