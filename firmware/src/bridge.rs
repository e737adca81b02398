//! The motor bridge: TIM1 channel 1 closes (PA8), channel 2 opens (PA9), 20 kHz.

use embassy_stm32::gpio::OutputType;
use embassy_stm32::pac;
use embassy_stm32::pac::gpio::vals::Moder;
use embassy_stm32::peripherals::{PA8, PA9, TIM1};
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::low_level::CountingMode;
use embassy_stm32::timer::simple_pwm::{PwmPin, SimplePwm, SimplePwmChannel, SimplePwmChannels};
use embassy_stm32::{Peri, timer};
use tenax_hal_shim::motor::{Duty, MotorBridge, MotorDrive};

/// Above what a person hears, and 5000 timer ticks a period at 100 MHz: five for each per mille.
const PWM_HZ: Hertz = Hertz(20_000);

type Side = SimplePwmChannel<'static, TIM1>;

/// Both sides of the bridge. A side that is not driven is low.
pub struct Bridge {
    close: Side,
    open: Side,
}

impl Bridge {
    /// Takes the timer and the pins; neither side is driven.
    pub fn new(timer: Peri<'static, TIM1>, close: Peri<'static, PA8>, open: Peri<'static, PA9>) -> Self {
        let pwm = SimplePwm::new(
            timer,
            Some(PwmPin::<_, timer::Ch1>::new(close, OutputType::PushPull)),
            Some(PwmPin::<_, timer::Ch2>::new(open, OutputType::PushPull)),
            None,
            None,
            PWM_HZ,
            CountingMode::EdgeAlignedUp,
        );
        let SimplePwmChannels { ch1: mut close, ch2: mut open, .. } = pwm.split();
        for side in [&mut close, &mut open] {
            side.set_duty_cycle_fully_off();
            side.enable();
        }
        Self { close, open }
    }
}

impl MotorBridge for Bridge {
    /// Takes effect when the running PWM period ends, within 50 us.
    ///
    /// The side to be released is always written first: the timer takes both over together at the end of a period, so
    /// whichever side of that instant the two writes fall, never are both driven.
    fn drive(&mut self, drive: MotorDrive) {
        match drive {
            MotorDrive::Coast => {
                self.close.set_duty_cycle_fully_off();
                self.open.set_duty_cycle_fully_off();
            }
            MotorDrive::Close(duty) => drive_side(&mut self.close, &mut self.open, duty),
            MotorDrive::Open(duty) => drive_side(&mut self.open, &mut self.close, duty),
        }
    }
}

fn drive_side(driven: &mut Side, released: &mut Side, duty: Duty) {
    released.set_duty_cycle_fully_off();
    driven.set_duty_cycle_fraction(u32::from(duty.as_per_mille()), u32::from(Duty::FULL.as_per_mille()));
}

/// Stops driving the motor from anywhere, whatever state the image is in: for a panic or a fault, after which nobody
/// drives it again before a reset.
///
/// The timer's outputs go off at once, without waiting for the period's end; then the pins are taken away from it and
/// held low.
pub fn off() {
    pac::TIM1.bdtr().modify(|w| w.set_moe(false));
    for pin in [8, 9] {
        pac::GPIOA.bsrr().write(|w| w.set_br(pin, true));
        pac::GPIOA.moder().modify(|w| w.set_moder(pin, Moder::OUTPUT));
    }
}
