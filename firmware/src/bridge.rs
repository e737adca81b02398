//! The motor bridge: TIM1 channel 1 closes (PA8), channel 4 opens (PA11), 20 kHz. The driven side is high throughout and the other one for
//! the rest of each pulse: then both are, which short-circuits the motor (slow decay), and the mean voltage is the duty's. With the other
//! side low the motor would coast between pulses, and lose its current to the supply.
//! Runs in control (2), and in whoever fails. Owns TIM1, PA8, PA11. Never waits for an edge.

#[path = "bridge/edges.rs"]
mod edges;

use embassy_stm32::Peri;
use embassy_stm32::pac;
use embassy_stm32::pac::gpio::vals::{Moder, Ospeedr};
use embassy_stm32::pac::timer::vals::{Bkp, Ocm, Ossi};
use embassy_stm32::peripherals::{PA8, PA11, TIM1};
use embassy_stm32::rcc;
use tenax_hal_shim::motor::{Duty, MotorBridge, MotorDrive};

use crate::timing::{PWM_TICKS, TICKS_PER_MILLE};

/// The timer's channels of both sides, counted from 0.
const CLOSE: usize = 0;
const OPEN: usize = 3;
/// Their pins of port A, and the function of both that is the timer's (DS10314, table 9). Channel 2's pin, PA9, is the serial output of the
/// chip's boot program, which holds it high where BOOT0 is high (AN2606): a bridge there would open the hand at full duty.
const PINS: [usize; 2] = [8, 11];
const TIM1_PINS: u8 = 1;

pub struct Bridge {
    /// The duty for which its edges have their place.
    placed: Duty,
}

impl Bridge {
    pub fn new(_timer: Peri<'static, TIM1>, _close: Peri<'static, PA8>, _open: Peri<'static, PA11>) -> Self {
        rcc::enable_and_reset::<TIM1>();
        let timer = pac::TIM1;
        timer.arr().write(|w| w.set_arr(PWM_TICKS - 1));
        for side in [CLOSE, OPEN] {
            timer.ccmr_output(side / 2).modify(|w| {
                w.set_ocm(side % 2, Ocm::PWM_MODE1);
                w.set_ocpe(side % 2, true);
            });
        }
        timer.ccer().write(|w| {
            w.set_cce(CLOSE, true);
            w.set_cce(OPEN, true);
        });
        // Where the timer's outputs are off they are low and not left to float. A debugger that halts the core stops this timer, and the
        // chip then switches its outputs off (RM0090, section 38.16.2: "as if the MOE bit was reset"): a probe may stop the watchdog,
        // too, and a halted core would drive the motor until somebody goes on.
        timer.bdtr().write(|w| {
            w.set_ossi(Ossi::IDLE_LEVEL);
            // A crystal that stops switches them off as well (RM0383, section 12.3.12); the break's pin is wired nowhere, and low.
            w.set_bkp(0, Bkp::ACTIVE_HIGH);
            w.set_bke(0, true);
            w.set_moe(true);
        });
        pac::DBGMCU.apb2fzr().modify(|w| w.set_tim1(true));
        timer.cr1().write(|w| w.set_arpe(true));
        timer.egr().write(|w| w.set_ug(true));
        timer.cr1().modify(|w| w.set_cen(true));
        for pin in PINS {
            pac::GPIOA.ospeedr().modify(|w| w.set_ospeedr(pin, Ospeedr::VERY_HIGH_SPEED));
            pac::GPIOA.afr(1).modify(|w| w.set_afr(pin - 8, TIM1_PINS));
            pac::GPIOA.moder().modify(|w| w.set_moder(pin, Moder::ALTERNATE));
        }
        Self { placed: Duty::default() }
    }

    fn drive_side(&mut self, side: usize, duty: Duty) {
        let brakes = PWM_TICKS - duty.as_per_mille() * TICKS_PER_MILLE;
        self.show(if side == CLOSE { [PWM_TICKS, brakes] } else { [brakes, PWM_TICKS] });
        if duty != self.placed {
            self.placed = duty;
            edges::place(brakes);
        }
    }

    /// Ticks of a period in which each side is high. One update takes both over: in no period is one side new and the other old.
    fn show(&mut self, [close, open]: [u16; 2]) {
        let timer = pac::TIM1;
        timer.cr1().modify(|w| w.set_udis(true));
        timer.ccr(CLOSE).write(|w| w.set_ccr(close));
        timer.ccr(OPEN).write(|w| w.set_ccr(open));
        timer.cr1().modify(|w| w.set_udis(false));
    }
}

impl MotorBridge for Bridge {
    /// Takes effect when the running PWM period ends, within 50 us; 53 where its edges are moved, 100 where it ends meanwhile.
    fn drive(&mut self, drive: MotorDrive) {
        match drive {
            MotorDrive::Close(duty) if duty > Duty::default() => self.drive_side(CLOSE, duty),
            MotorDrive::Open(duty) if duty > Duty::default() => self.drive_side(OPEN, duty),
            _ => self.show([0, 0]),
        }
    }
}

/// Stops driving the motor from anywhere, for a panic or a fault: the timer's outputs go off without waiting for the period's end; then
/// the pins are held low.
pub fn off() {
    pac::TIM1.bdtr().modify(|w| w.set_moe(false));
    hold_low();
}

/// Both pins low, from the first instants of a start on: they float after a reset.
pub fn hold_low() {
    for pin in PINS {
        pac::GPIOA.bsrr().write(|w| w.set_br(pin, true));
        pac::GPIOA.moder().modify(|w| w.set_moder(pin, Moder::OUTPUT));
    }
}
