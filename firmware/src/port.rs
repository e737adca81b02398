//! A serial port whose bytes DMA carries both ways: into a ring, and out of a frame. Of the palm's bus, at both of its ends.

use core::sync::atomic::{Ordering::SeqCst, compiler_fence};

use embassy_stm32::pac::dma::Dma;
use embassy_stm32::pac::dma::regs::{Ixr, Ndtr};
use embassy_stm32::pac::dma::vals::Dir;
use embassy_stm32::pac::gpio::vals::{Moder, Ospeedr, Pupdr};
use embassy_stm32::pac::usart::Usart;
use embassy_stm32::pac::usart::regs::Sr;
use embassy_stm32::pac::{DMA2, GPIOA, USART1};

/// The channel of every port's streams, and the function of its pins (RM0383, tables 27 and 28; DS10314, table 9).
const CHANNEL: u8 = 4;
const PINS: u8 = 7;

/// A port, its controller, and its streams there, both of the upper four.
#[derive(Clone, Copy)]
pub struct Port {
    /// The port.
    pub usart: Usart,
    /// The controller of both streams.
    pub dma: Dma,
    /// Of what comes.
    pub rx: usize,
    /// Of what goes.
    pub tx: usize,
}

/// USART1, of the bus.
pub const BUS: Port = Port { usart: USART1, dma: DMA2, rx: 5, tx: 7 };

impl Port {
    /// Listens from now on, at the port's clock over `divider`: bytes go around in `ring`. Its own clock runs; both pins are on port A.
    pub fn open(self, divider: u16, pins: [usize; 2], ring: *mut [u8]) {
        for pin in pins {
            // Nobody may drive the receiver's.
            GPIOA.pupdr().modify(|w| w.set_pupdr(pin, Pupdr::PULL_UP));
            GPIOA.ospeedr().modify(|w| w.set_ospeedr(pin, Ospeedr::MEDIUM_SPEED));
            GPIOA.afr(pin / 8).modify(|w| w.set_afr(pin % 8, PINS));
            GPIOA.moder().modify(|w| w.set_moder(pin, Moder::ALTERNATE));
        }
        let Self { usart, dma, rx, .. } = self;
        let rx = dma.st(rx);
        rx.par().write_value(usart.dr().as_ptr() as u32);
        rx.m0ar().write_value(ring.cast::<u8>() as u32);
        rx.ndtr().write_value(Ndtr(ring.len() as u32));
        rx.cr().write(|w| {
            w.set_chsel(CHANNEL);
            w.set_dir(Dir::PERIPHERAL_TO_MEMORY);
            w.set_minc(true);
            w.set_circ(true);
            w.set_en(true);
        });
        usart.brr().write(|w| w.set_brr(divider));
        usart.cr3().write(|w| {
            w.set_dmar(true);
            w.set_dmat(true);
        });
        usart.cr1().write(|w| {
            w.set_ue(true);
            w.set_te(true);
            w.set_re(true);
            w.set_idleie(true);
        });
    }

    /// Bytes that are left of a ring until DMA begins anew.
    pub fn left(self) -> usize {
        self.dma.st(self.rx).ndtr().read().0 as usize
    }

    /// This frame is sent next. The last is over.
    pub fn prepare(self, frame: *const u8, length: usize) {
        let tx = self.dma.st(self.tx);
        tx.par().write_value(self.usart.dr().as_ptr() as u32);
        tx.m0ar().write_value(frame as u32);
        tx.ndtr().write_value(Ndtr(length as u32));
    }

    /// Sends the frame that was prepared; its end is an interrupt's, where one is enabled.
    pub fn begin(self) {
        let Self { usart, dma, tx, .. } = self;
        let mut flags = Ixr(0);
        flags.set_tcif(tx - 4, true);
        flags.set_htif(tx - 4, true);
        flags.set_feif(tx - 4, true);
        dma.ifcr(1).write_value(flags);
        // Of what a written zero clears, only that all is sent.
        let mut sent = Sr(u32::MAX);
        sent.set_tc(false);
        usart.sr().write_value(sent);
        compiler_fence(SeqCst);
        dma.st(tx).cr().write(|w| {
            w.set_chsel(CHANNEL);
            w.set_dir(Dir::MEMORY_TO_PERIPHERAL);
            w.set_minc(true);
            w.set_en(true);
        });
        usart.cr1().modify(|w| w.set_tcie(true));
    }

    /// Nothing more is sent.
    pub fn end(self) {
        self.usart.cr1().modify(|w| w.set_tcie(false));
        self.dma.st(self.tx).cr().write(|w| w.set_en(false));
    }
}
