//! The motor bridge: TIM1 channel 1 closes (PA8), channel 2 opens (PA9), 20 kHz.

use embassy_stm32::gpio::OutputType;
use embassy_stm32::pac;
use embassy_stm32::pac::gpio::vals::Moder;
use embassy_stm32::pac::timer::vals::Ossi;
use embassy_stm32::peripherals::{PA8, PA9, TIM1};
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::low_level::CountingMode;
use embassy_stm32::timer::simple_pwm::{PwmPin, SimplePwm, SimplePwmChannel, SimplePwmChannels};
use embassy_stm32::{Peri, timer};
use tenax_hal_shim::motor::{Duty, MotorBridge, MotorDrive};

/// Above what a person hears, and 5000 timer ticks a period at 100 MHz: five for each per mille.
const PWM_HZ: Hertz = Hertz(20_000);

/// The timer's channels of both sides, counted from 0.
const CLOSE: usize = 0;
const OPEN: usize = 1;

/// Both sides of the bridge. A side that is not driven is low.
pub struct Bridge {
    _sides: [SimplePwmChannel<'static, TIM1>; 2],
    /// What a side is compared with to be driven all the time, timer ticks.
    full: u32,
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
        let SimplePwmChannels { ch1, ch2, .. } = pwm.split();
        let mut sides = [ch1, ch2];
        let full = sides[0].max_duty_cycle();
        // Where the timer's outputs are off they are low and not left to float. A debugger that halts the core stops this timer, and the
        // chip then switches its outputs off (RM0090, section 38.16.2: "as if the MOE bit was reset"): a probe may stop the watchdog,
        // too, and a halted core would drive the motor until somebody goes on.
        pac::TIM1.bdtr().modify(|w| w.set_ossi(Ossi::IDLE_LEVEL));
        pac::DBGMCU.apb2fzr().modify(|w| w.set_tim1(true));
        for side in &mut sides {
            side.set_duty_cycle_fully_off();
            side.enable();
        }
        Self { _sides: sides, full }
    }

    fn drive_side<const DRIVEN: usize, const RELEASED: usize>(&self, duty: Duty) {
        compare::<RELEASED>(0);
        compare::<DRIVEN>(u32::from(duty.as_per_mille()) * self.full / u32::from(Duty::FULL.as_per_mille()));
    }
}

/// Gives the bridge's edges their place between the scans'. Call it where the scans' timer is started.
///
/// A scan lasts 2.5 periods, so a rising edge comes 13.6 us after the first code of one scan and 38.6 after that of the next: as the
/// sixth film begins to be sampled, which has 2.2 us to settle, and after the last code. By chance, from one start to the next, it would
/// fall into the end of some film's sampling.
pub fn align() {
    pac::TIM1.cnt().write(|w| w.set_cnt(PHASE));
}

/// Ticks of the timer's period that are over when the scans' timer starts, whose first trigger comes 125 us later.
const PHASE: u16 = 5_000 - 1_360;

/// Drives a side for so many ticks of each period. embassy's own function asserts what holds here by itself, and no tick may
/// have a way to panic.
fn compare<const SIDE: usize>(ticks: u32) {
    pac::TIM1.ccr(SIDE).write(|w| w.set_ccr(ticks as u16));
}

impl MotorBridge for Bridge {
    /// Takes effect when the running PWM period ends, within 50 us.
    ///
    /// The side to be released is always written first: the timer takes both over together at the end of a period, so
    /// whichever side of that instant the two writes fall, never are both driven.
    fn drive(&mut self, drive: MotorDrive) {
        match drive {
            MotorDrive::Coast => {
                compare::<CLOSE>(0);
                compare::<OPEN>(0);
            }
            MotorDrive::Close(duty) => self.drive_side::<CLOSE, OPEN>(duty),
            MotorDrive::Open(duty) => self.drive_side::<OPEN, CLOSE>(duty),
        }
    }
}

/// Stops driving the motor from anywhere, whatever state the image is in: for a panic or a fault, after which nobody
/// drives it again before a reset.
///
/// The timer's outputs go off at once, without waiting for the period's end; then the pins are taken away from it and
/// held low.
pub fn off() {
    pac::TIM1.bdtr().modify(|w| w.set_moe(false));
    hold_low();
}

/// Both pins low, from the first instants of a start on: they float after a reset, and the clock may be waited for.
pub fn hold_low() {
    pac::RCC.ahb1enr().modify(|w| w.set_gpioaen(true));
    for pin in [8, 9] {
        pac::GPIOA.bsrr().write(|w| w.set_br(pin, true));
        pac::GPIOA.moder().modify(|w| w.set_moder(pin, Moder::OUTPUT));
    }
}
