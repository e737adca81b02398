//! The wires between the chip's pins and the world: what a plant puts in, what it takes out.

use rigless::mcu::Operate;
use rigless::soc::Width;
use rigless::soc::stm32f427::peripherals::adc::Channel;
use rigless::time::VirtualNanos;
use tenax_hal_shim::channel::SCAN;
use tenax_hal_shim::frame::Scan;
use tenax_hal_shim::motor::{Duty, MotorDrive};

use super::nucleo::Nucleo;

const GPIOA_MODER: u64 = 0x4002_0000;
const GPIOA_ODR: u64 = 0x4002_0014;
const GPIOA_AFRH: u64 = 0x4002_0024;
const GPIOC_PUPDR: u64 = 0x4002_080C;
const GPIOB_ODR: u64 = 0x4002_0414;
const TIM1_CCER: u64 = 0x4001_0020;
const TIM1_CNT: u64 = 0x4001_0024;
const TIM1_ARR: u64 = 0x4001_002C;
const TIM1_CCR1: u64 = 0x4001_0034;
const TIM1_CCR4: u64 = 0x4001_0040;
const TIM1_BDTR: u64 = 0x4001_0044;
const GPIOB_MODER: u64 = 0x4002_0400;
const GPIOB_AFRL: u64 = 0x4002_0420;
const TIM4_CR1: u64 = 0x4000_0800;
const TIM4_CCER: u64 = 0x4000_0820;
const TIM4_ARR: u64 = 0x4000_082C;
const TIM4_CCR1: u64 = 0x4000_0834;
const ADC1_CR2: u64 = 0x4001_2008;

const BDTR_MOE: u32 = 1 << 15;
const CCER_CC1E: u32 = 1;
const CCER_CC4E: u32 = 1 << 12;
const CR1_CEN: u32 = 1;
const CR2_ADON: u32 = 1;
const CR2_EXTSEL: u32 = 0xF << 24;
const CR2_EXTSEL_TIM3_TRGO: u32 = 0x8 << 24;
const CR2_EXTEN: u32 = 0x3 << 28;
const CR2_SWSTART: u32 = 1 << 30;
const PULL_UP: u32 = 0b01;
const PULL_DOWN: u32 = 0b10;
const MODER_OUTPUT: u32 = 0b01;
const MODER_ALTERNATE: u32 = 0b10;
const AF_TIM1: u32 = 1;
const AF_TIM4: u32 = 2;

/// Pins of port C: the button's, and the bridge's nFAULT.
pub const BUTTON: u32 = 13;
pub const BRIDGE_FAULT: u32 = 8;

pub struct Wires<'a> {
    board: &'a mut Nucleo,
    now: VirtualNanos,
}

impl<'a> Wires<'a> {
    /// The wires as they are at `now`, to which the chip has advanced.
    pub fn new(board: &'a mut Nucleo, now: VirtualNanos) -> Self {
        Self { board, now }
    }

    fn peek(&mut self, address: u64) -> u32 {
        self.board.peek(self.now, address) as u32
    }

    pub fn select(&mut self) -> u8 {
        (self.peek(GPIOB_ODR) >> 12 & 0xF) as u8
    }

    /// How the bridge (DRV8874, table 4) drives the motor. None: it neither coasts nor drives with slow decay, so that duty is not voltage.
    pub fn motor(&mut self) -> Option<MotorDrive> {
        let [close, open] = [(8, TIM1_CCR1, CCER_CC1E), (11, TIM1_CCR4, CCER_CC4E)]
            .map(|(pin, compare, enable)| self.high_permille(pin, compare, enable));
        match (close, open) {
            (0, 0) => Some(MotorDrive::Coast),
            (1_000, braked @ ..1_000) => Some(MotorDrive::Close(Duty::per_mille(1_000 - braked))),
            (braked @ ..1_000, 1_000) => Some(MotorDrive::Open(Duty::per_mille(1_000 - braked))),
            _ => None,
        }
    }

    pub fn bridge_begins_us(&mut self) -> f64 {
        let since_us = self.board.since_pulse_ns(self.now) as f64 / 1e3;
        since_us - f64::from(self.peek(TIM1_CNT)) / 100.0
    }

    /// Part of the PWM's period in which a pin of port A is high, per mille: the bridge pulls its inputs low.
    fn high_permille(&mut self, pin: u32, compare: u64, enable: u32) -> u16 {
        match self.peek(GPIOA_MODER) >> (2 * pin) & 0b11 {
            MODER_OUTPUT => 1_000 * (self.peek(GPIOA_ODR) >> pin & 1) as u16,
            MODER_ALTERNATE => {
                let on = self.peek(GPIOA_AFRH) >> (4 * (pin - 8)) & 0xF == AF_TIM1
                    && self.peek(TIM1_BDTR) & BDTR_MOE != 0
                    && self.peek(TIM1_CCER) & enable != 0;
                let period = self.peek(TIM1_ARR) + 1;
                if on { (self.peek(compare).min(period) * 1_000 / period) as u16 } else { 0 }
            }
            _ => 0,
        }
    }

    pub fn vibration(&mut self) -> Duty {
        let compare = self.peek(TIM4_CCR1);
        let wired = compare > 0
            && self.peek(GPIOB_MODER) >> 12 & 0b11 == MODER_ALTERNATE
            && self.peek(GPIOB_AFRL) >> 24 & 0xF == AF_TIM4
            && self.peek(TIM4_CR1) & CR1_CEN != 0
            && self.peek(TIM4_CCER) & CCER_CC1E != 0;
        let per_mille = (compare * 1_000).div_ceil(self.peek(TIM4_ARR) + 1);
        if wired { Duty::per_mille(per_mille as u16) } else { Duty::default() }
    }

    pub fn put(&mut self, scan: &Scan) {
        for (rank, &code) in SCAN.iter().zip(scan) {
            let channel = Channel::new(rank.adc).expect("the channel map has pin channels");
            self.board.chip.adc[0].set_input(channel, u32::from(code));
        }
    }

    /// Pulls a pin of port C low, or lets it go: `rigless` lets nobody but a peripheral drive a pin, and one that nothing drives reads its pull.
    pub fn pull(&mut self, pin: u32, is_low: bool) {
        let at = 2 * pin;
        let pulls = self.peek(GPIOC_PUPDR) & !(0b11 << at) | if is_low { PULL_DOWN } else { PULL_UP } << at;
        if pulls != self.peek(GPIOC_PUPDR) {
            // Before the image has clocked the port nothing reads it either.
            let _ = self.board.chip.write(self.now, GPIOC_PUPDR, Width::W32, u64::from(pulls));
        }
    }

    /// A pulse of TIM3's TRGO starts the converter's sequence if the converter listens to it: the wire that `rigless` leaves out.
    pub fn trigger(&mut self) {
        let cr2 = self.peek(ADC1_CR2);
        let on_trgo = cr2 & CR2_EXTEN != 0 && cr2 & CR2_EXTSEL == CR2_EXTSEL_TIM3_TRGO;
        if cr2 & CR2_ADON != 0 && on_trgo {
            self.board.poke(self.now, ADC1_CR2, u64::from(cr2 | CR2_SWSTART));
        }
    }
}
