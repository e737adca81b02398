//! The serial line of the ST-LINK: USART2, its DMA, its interrupts. Through the PAC: embassy's driver has twenty ways to panic, two of
//! them in an interrupt.

use core::future::poll_fn;
use core::marker::PhantomData;
use core::ptr::addr_of_mut;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering, fence};
use core::task::Poll;

use embassy_stm32::interrupt::{InterruptExt, Priority};
use embassy_stm32::pac::dma::regs::{Ixr, Ndtr};
use embassy_stm32::pac::dma::vals::Dir;
use embassy_stm32::pac::gpio::vals::{Moder, Ospeedr, Pupdr};
use embassy_stm32::pac::{self, DMA1, GPIOA, USART2};
use embassy_stm32::peripherals::{self, DMA1_CH5, DMA1_CH6, PA2, PA3};
use embassy_stm32::{Peri, interrupt};
use embassy_sync::waitqueue::AtomicWaker;
use tenax_hal_shim::wire::BAUD;
use tenax_logic::restart::Mark;

use crate::clock::APB1_HZ;
use crate::counts;
use crate::last_words::give_up;

/// Streams of DMA1, and the channel that both are for USART2 (RM0383, table 27).
const RX: usize = 5;
const TX: usize = 6;
const CHANNEL: u8 = 4;
/// Position of a stream's flags in its register, which has those of four streams.
const RX_FLAGS: usize = RX - 4;
const TX_FLAGS: usize = TX - 4;
/// The function of both pins that is the port's (DS10314, table 9).
const USART2_PINS: u8 = 7;
/// Bytes that DMA writes around in: 11 ms of a full line, and who reads them needs far less to get its turn.
const RING_LEN: u32 = 1024;
const HALF: u32 = RING_LEN / 2;

static mut RING: [u8; RING_LEN as usize] = [0; RING_LEN as usize];
/// Halves of the ring that were filled. Only the interrupt counts up.
static FILLED: AtomicU32 = AtomicU32::new(0);
static SENT: AtomicBool = AtomicBool::new(true);
static SENDER: AtomicWaker = AtomicWaker::new();
static READER: AtomicWaker = AtomicWaker::new();

pub struct Up {
    _taken: (),
}

pub struct Down {
    /// Bytes that were read. It wraps.
    read: u32,
}

/// More came than was read in time: some of it is lost.
pub struct Overrun;

pub fn open(
    _port: Peri<'static, peripherals::USART2>,
    _streams: (Peri<'static, DMA1_CH5>, Peri<'static, DMA1_CH6>),
    _pins: (Peri<'static, PA2>, Peri<'static, PA3>),
) -> (Up, Down) {
    // Nobody may be at the other end.
    GPIOA.pupdr().modify(|w| w.set_pupdr(3, Pupdr::PULL_UP));
    for pin in [2, 3] {
        GPIOA.ospeedr().modify(|w| w.set_ospeedr(pin, Ospeedr::MEDIUM_SPEED));
        GPIOA.afr(0).modify(|w| w.set_afr(pin, USART2_PINS));
        GPIOA.moder().modify(|w| w.set_moder(pin, Moder::ALTERNATE));
    }
    let rx = DMA1.st(RX);
    rx.par().write_value(USART2.dr().as_ptr() as u32);
    rx.m0ar().write_value(addr_of_mut!(RING) as u32);
    rx.ndtr().write_value(Ndtr(RING_LEN));
    rx.cr().write(|w| {
        w.set_chsel(CHANNEL);
        w.set_dir(Dir::PERIPHERAL_TO_MEMORY);
        w.set_minc(true);
        w.set_circ(true);
        w.set_teie(true);
        w.set_htie(true);
        w.set_tcie(true);
        w.set_en(true);
    });
    USART2.brr().write(|w| w.set_brr(((APB1_HZ + BAUD / 2) / BAUD) as u16));
    USART2.cr3().write(|w| {
        w.set_dmar(true);
        w.set_dmat(true);
        w.set_eie(true);
    });
    USART2.cr1().write(|w| {
        w.set_ue(true);
        w.set_te(true);
        w.set_re(true);
        w.set_idleie(true);
    });
    interrupt::USART2.set_priority(Priority::P6);
    interrupt::DMA1_STREAM5.set_priority(Priority::P6);
    interrupt::DMA1_STREAM6.set_priority(Priority::P6);
    // SAFETY: what their handlers use is set up above.
    unsafe {
        interrupt::USART2.enable();
        interrupt::DMA1_STREAM5.enable();
        interrupt::DMA1_STREAM6.enable();
    }
    (Up { _taken: () }, Down { read: 0 })
}

struct Sending<'f>(PhantomData<&'f [u8]>);

impl Drop for Sending<'_> {
    fn drop(&mut self) {
        DMA1.st(TX).cr().write(|w| w.set_en(false));
        while DMA1.st(TX).cr().read().en() {}
    }
}

impl Up {
    /// Sends it; over when DMA has handed on its last byte. Not an `async fn`, as [`Deadline::until`](crate::deadline::Deadline::until).
    pub fn send<'f>(&'f mut self, frame: &'f [u8]) -> impl Future<Output = ()> + 'f {
        let sending = Sending(PhantomData);
        SENT.store(false, Ordering::Relaxed);
        let tx = DMA1.st(TX);
        tx.par().write_value(USART2.dr().as_ptr() as u32);
        tx.m0ar().write_value(frame.as_ptr() as u32);
        tx.ndtr().write_value(Ndtr(frame.len() as u32));
        // The frame is written before.
        fence(Ordering::SeqCst);
        tx.cr().write(|w| {
            w.set_chsel(CHANNEL);
            w.set_dir(Dir::MEMORY_TO_PERIPHERAL);
            w.set_minc(true);
            w.set_teie(true);
            w.set_tcie(true);
            w.set_en(true);
        });
        poll_fn(move |context| {
            let _while_it_is_read = &sending;
            SENDER.register(context.waker());
            if SENT.load(Ordering::Acquire) { Poll::Ready(()) } else { Poll::Pending }
        })
    }
}

impl Down {
    pub fn read<'b>(&'b mut self, bytes: &'b mut [u8]) -> impl Future<Output = Result<usize, Overrun>> + 'b {
        poll_fn(move |context| {
            // Before it is asked: what comes in between wakes.
            READER.register(context.waker());
            match self.take(bytes) {
                Ok(0) => Poll::Pending,
                taken => Poll::Ready(taken),
            }
        })
    }

    fn take(&mut self, bytes: &mut [u8]) -> Result<usize, Overrun> {
        let waiting = written().wrapping_sub(self.read);
        let count = (waiting as usize).min(bytes.len());
        for (byte, at) in bytes.iter_mut().zip(0..waiting) {
            let place = (self.read.wrapping_add(at) % RING_LEN) as usize;
            // SAFETY: within the ring, which DMA writes behind the compiler's back.
            *byte = unsafe { addr_of_mut!(RING).cast::<u8>().add(place).read_volatile() };
        }
        // Now, so that none of them was overwritten before it was taken.
        let written = written();
        if written.wrapping_sub(self.read) > RING_LEN {
            self.read = written;
            return Err(Overrun);
        }
        self.read = self.read.wrapping_add(count as u32);
        Ok(count)
    }
}

/// Bytes that DMA has written. It wraps. For who runs below the interrupt: a half that is filled has been counted.
fn written() -> u32 {
    loop {
        let filled = FILLED.load(Ordering::Acquire);
        let place = RING_LEN.wrapping_sub(DMA1.st(RX).ndtr().read().0);
        if FILLED.load(Ordering::Acquire) == filled {
            let whole = filled.wrapping_mul(HALF);
            return whole.wrapping_add(place.wrapping_sub(whole) % RING_LEN);
        }
    }
}

/// The line is silent, or what came is none of ours: a byte without its stop bit, noise, or one that DMA did not fetch.
#[interrupt]
unsafe fn USART2() {
    let seen = USART2.sr().read();
    let failed = seen.ore() || seen.ne() || seen.fe();
    if seen.idle() || failed {
        // With the status before, this clears the flags.
        let _last = USART2.dr().read();
        if failed {
            counts::BAD_FRAMES.add_one();
        }
        READER.wake();
    }
}

#[interrupt]
unsafe fn DMA1_STREAM5() {
    let seen = clear(RX_FLAGS);
    let filled = u32::from(seen.htif(RX_FLAGS)) + u32::from(seen.tcif(RX_FLAGS));
    // Nobody else writes to it, so this needs no exclusive access.
    FILLED.store(FILLED.load(Ordering::Relaxed).wrapping_add(filled), Ordering::Release);
    READER.wake();
}

#[interrupt]
unsafe fn DMA1_STREAM6() {
    if clear(TX_FLAGS).tcif(TX_FLAGS) {
        SENT.store(true, Ordering::Release);
        SENDER.wake();
    }
}

/// Clears the flags of the stream that has these, and says which stood.
fn clear(stream: usize) -> Ixr {
    let seen = pac::DMA1.isr(1).read();
    if seen.teif(stream) {
        give_up(Mark::Panicked, "DMA could not reach the line's memory");
    }
    let mut own = Ixr(0);
    own.set_feif(stream, seen.feif(stream));
    own.set_dmeif(stream, seen.dmeif(stream));
    own.set_htif(stream, seen.htif(stream));
    own.set_tcif(stream, seen.tcif(stream));
    pac::DMA1.ifcr(1).write_value(own);
    seen
}
