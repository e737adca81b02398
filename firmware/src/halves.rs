//! The ring that DMA writes the converter's codes to: two halves of a frame each, one of which is read while the other is written.
//! embassy's ring buffer gives any number of codes from anywhere in the ring, one by one. Here a frame is a half, which is read where it
//! lies, two codes in a word.
//! Its handler runs at the scan's priority (1), the rest in control (2). Owns DMA2's stream 0 and the ring. Never touches the converter.

use core::sync::atomic::{AtomicU32, Ordering, fence};

use embassy_stm32::Peri;
use embassy_stm32::interrupt::typelevel::{self, Handler};
use embassy_stm32::pac::dma::vals::{Dir, Dmdis, Pl, Size};
use embassy_stm32::pac::{self, dma::regs::Ndtr};
use embassy_stm32::peripherals::DMA2_CH0;
use tenax_hal_shim::channel::{SCAN_LEN, SCANS_PER_FRAME};
use tenax_hal_shim::frame::{Frame, PAIRS};
use tenax_logic::restart::Mark;

use crate::deadline::SCAN_WAKER;
use crate::last_words::give_up;
use crate::timing::STREAM_LOOKS;

const HALF: usize = PAIRS * SCANS_PER_FRAME;
pub const RING_LEN: usize = 2 * HALF;
/// The converter's stream (RM0383, table 28), whose request is the stream's channel 0.
const STREAM: usize = 0;

/// Halves that DMA has filled since it was started. Only the interrupt counts up.
static FILLED: AtomicU32 = AtomicU32::new(0);

/// DMA is in the half that was to be read: it came round again, or was stopped there.
pub struct NotWhole;

pub struct Halves<'r> {
    _stream: Peri<'r, DMA2_CH0>,
    ring: &'r mut [u32; RING_LEN],
    read: u32,
}

impl<'r> Halves<'r> {
    /// Lets DMA fetch every code from `source`, the converter's data register, whose requests come afterwards.
    pub fn start(stream: Peri<'r, DMA2_CH0>, ring: &'r mut [u32; RING_LEN], source: *mut u32) -> Self {
        stop();
        FILLED.store(0, Ordering::Relaxed);
        let registers = pac::DMA2.st(STREAM);
        registers.par().write_value(source as u32);
        registers.m0ar().write_value(ring.as_mut_ptr() as u32);
        registers.ndtr().write_value(Ndtr((2 * RING_LEN) as u32));
        registers.fcr().write(|w| w.set_dmdis(Dmdis::ENABLED));
        // What is written above and to the ring comes before.
        fence(Ordering::SeqCst);
        registers.cr().write(|w| {
            w.set_dir(Dir::PERIPHERAL_TO_MEMORY);
            w.set_msize(Size::BITS16);
            w.set_psize(Size::BITS16);
            w.set_minc(true);
            w.set_circ(true);
            w.set_pl(Pl::VERY_HIGH);
            w.set_teie(true);
            w.set_htie(true);
            w.set_tcie(true);
            w.set_en(true);
        });
        Self { _stream: stream, ring, read: 0 }
    }

    pub fn is_filled(&self) -> bool {
        FILLED.load(Ordering::Acquire) != self.read
    }

    /// Reads the half that was filled, as the frame of this number.
    pub fn read(&mut self, sequence: u32) -> Result<Frame, NotWhole> {
        let is_first = self.read.is_multiple_of(2);
        let first = if is_first { 0 } else { HALF };
        let half: *const u32 = &raw const self.ring[first];
        let frame = Frame::from_pairs(sequence, |scan, pair| {
            // SAFETY: `scan` and `pair` are below their numbers, so this word is in the half; DMA changes it behind the
            // compiler's back, hence volatile.
            unsafe { half.add(scan * PAIRS + pair).read_volatile() }
        });
        self.read = self.read.wrapping_add(1);
        // Codes left until the ring's end: those of a half or fewer while DMA is in the second.
        let in_second = pac::DMA2.st(STREAM).ndtr().read().0 <= 2 * HALF as u32;
        let whole = in_second == is_first && FILLED.load(Ordering::Acquire) == self.read;
        if whole { Ok(frame) } else { Err(NotWhole) }
    }
}

impl Drop for Halves<'_> {
    fn drop(&mut self) {
        stop();
    }
}

/// Stops the stream; when this returns, nothing is written any more and no flag stands.
fn stop() {
    let registers = pac::DMA2.st(STREAM);
    registers.cr().write(|w| w.set_en(false));
    // A single transfer is all that it can be in the middle of.
    if (0..STREAM_LOOKS).all(|_| registers.cr().read().en()) {
        give_up(Mark::Panicked, "DMA does not stop");
    }
    clear(pac::DMA2.isr(0).read());
    fence(Ordering::SeqCst);
}

fn clear(seen: pac::dma::regs::Ixr) {
    pac::DMA2.ifcr(0).write(|w| {
        w.set_feif(STREAM, seen.feif(STREAM));
        w.set_dmeif(STREAM, seen.dmeif(STREAM));
        w.set_teif(STREAM, seen.teif(STREAM));
        w.set_htif(STREAM, seen.htif(STREAM));
        w.set_tcif(STREAM, seen.tcif(STREAM));
    });
}

/// The stream's interrupt: a half was filled.
pub struct OnHalf;

impl Handler<typelevel::DMA2_STREAM0> for OnHalf {
    unsafe fn on_interrupt() {
        let seen = pac::DMA2.isr(0).read();
        if seen.teif(STREAM) {
            // DMA could not reach the ring.
            give_up(Mark::Panicked, "DMA could not reach its ring");
        }
        clear(seen);
        // Both at once if the interrupt was kept waiting for a frame.
        let filled = u32::from(seen.htif(STREAM)) + u32::from(seen.tcif(STREAM));
        // No other code writes to it while the stream runs, so this needs no exclusive access.
        FILLED.store(FILLED.load(Ordering::Relaxed).wrapping_add(filled), Ordering::Release);
        SCAN_WAKER.wake();
    }
}

const _: () = assert!(SCAN_LEN == 2 * PAIRS);
