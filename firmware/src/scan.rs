//! The 14-channel scan: TIM3 starts it in hardware 8000 times a second, DMA carries it, one interrupt a frame.
//!
//! embassy's own ring-buffered converter (embassy-stm32 0.6.0) cannot do this: it writes every rank into SQR3, which holds six (mended
//! upstream after 0.6.0: embassy-rs/embassy#5791); it never looks at OVR, after which the converter is silent for ever; and it starts one
//! scan by software ahead of the first timed one. So the sequence is written here, through the PAC, and so is its DMA ([`halves`](crate::halves)).
//!
//! The scan's timer and the deadline's count the same clock, so the two never drift apart and the instant of every frame is known without
//! asking the converter: a frame that does not come in time is lost, and after a restart the sequence numbers go on where time has got to.
//! Runs in control (2). Owns ADC1, TIM3 and the analogue pins. Never waits without a deadline.

use embassy_stm32::Peri;
use embassy_stm32::pac::adc::regs::{Smpr1, Smpr2, Sqr1, Sqr2, Sqr3};
use embassy_stm32::pac::adc::vals::{Dds, Exten, SampleTime};
use embassy_stm32::pac::adccommon::vals::Adcpre;
use embassy_stm32::pac::timer::vals::Mms;
use embassy_stm32::pac::{self, ADC1_COMMON};
use embassy_stm32::peripherals::{ADC1, DMA2_CH0, TIM3};
use embassy_stm32::rcc;
use tenax_hal_shim::channel::{SCAN, SCAN_HZ, SCAN_LEN};
use tenax_hal_shim::frame::Frame;

use crate::counts;
use crate::deadline::{Deadline, Micros};
use crate::halves::{Halves, RING_LEN};
use crate::timing::{CORE_HZ, FRAME_US, PATIENCE_US, SCAN_US};

/// EXTSEL of the regular group: TIM3's TRGO (RM0383, section 11.12.3).
const EXTSEL_TIM3_TRGO: u8 = 0b1000;
/// 56 + 12 cycles at 25 MHz: a scan takes 38 us of its 125, and sources of up to 20 kohm settle (DS10314, equation 1).
const SAMPLE_TIME: SampleTime = SampleTime::CYCLES56;

pub struct Scan {
    _adc: Peri<'static, ADC1>,
    stream: Peri<'static, DMA2_CH0>,
    ring: &'static mut [u32; RING_LEN],
    _timer: Peri<'static, TIM3>,
    deadline: Deadline,
    due: Due,
}

struct Due {
    sequence: u32,
    begins: Micros,
}

impl Due {
    fn step(&mut self) {
        self.sequence = self.sequence.wrapping_add(1);
        self.begins = self.begins.after(FRAME_US);
    }
}

impl Scan {
    /// Takes the hardware; nothing is converted before [`run`](Self::run). `pins` are proof that nobody else uses them.
    pub fn new(
        adc: Peri<'static, ADC1>,
        timer: Peri<'static, TIM3>,
        stream: Peri<'static, DMA2_CH0>,
        ring: &'static mut [u32; RING_LEN],
        deadline: Deadline,
        _pins: impl Sized,
    ) -> Self {
        rcc::enable_and_reset::<TIM3>();
        rcc::enable_and_reset::<ADC1>();
        for (port, analog) in [pac::GPIOA, pac::GPIOB, pac::GPIOC].into_iter().zip(ANALOG) {
            port.moder().modify(|w| w.0 |= analog);
        }
        pac::TIM3.arr().write(|w| w.set_arr((CORE_HZ / SCAN_HZ - 1) as u16));
        pac::TIM3.cr2().write(|w| w.set_mms(Mms::UPDATE));
        let due = Due { sequence: 0, begins: deadline.now() };
        Self { _adc: adc, stream, ring, _timer: timer, deadline, due }
    }

    /// Hands every frame to `on_frame` as soon as its last code has been converted, for ever. Frames that are lost are handed over as such,
    /// so that whoever counts time by frames keeps time. `on_frame` has until the next frame begins, 87 us, to step the switches for it.
    /// All that waits stands in this one function: an `async fn` that has an end can be asked again after it, which is a way to panic.
    pub async fn run(mut self, mut on_frame: impl FnMut(&Frame)) -> ! {
        pac::TIM3.cr1().write(|w| w.set_cen(true));
        // The first trigger comes one period after the start.
        self.due.begins = self.deadline.now().after(SCAN_US);
        loop {
            let arm_at = self.catch_up(&mut on_frame);
            self.deadline.until(arm_at, || None::<()>).await;

            // Whatever the converter was doing is over.
            reset();
            let converter = pac::ADC1;
            let mut halves = Halves::start(self.stream.reborrow(), self.ring, converter.dr().as_ptr().cast());
            listen(converter);
            loop {
                let following_begins = self.due.begins.after(FRAME_US);
                let filled = || halves.is_filled().then_some(());
                if self.deadline.until(following_begins.after(PATIENCE_US), filled).await.is_none() {
                    // The converter had a code that DMA did not fetch (OVR), after which it is silent; or it is dead.
                    break;
                }
                // Read only after the following one had begun, or DMA was in it: it is not whole.
                let Ok(frame) = halves.read(self.due.sequence) else { break };
                // Then the switches do not show yet what the following frame is reading.
                let began = self.deadline.now();
                let behind = began.is_after(following_begins);
                on_frame(&frame);
                counts::FRAMES.add_one();
                let ended = self.deadline.now();
                counts::CONTROL_US.add(ended.since(began));
                counts::CONTROL_US_MAX.max(ended.since(began));
                if ended.is_after(following_begins) {
                    counts::TICKS_LATE.add_one();
                }
                self.due.step();
                if behind {
                    break;
                }
            }
            drop(halves);
            counts::OVERRUNS.add_one();
        }
    }

    /// Gives up the frames that have begun: the instant, still to come, at which the scan before the next one has been triggered.
    fn catch_up(&mut self, on_frame: &mut impl FnMut(&Frame)) -> Micros {
        loop {
            let arm_at = self.due.begins.before(SCAN_US / 2);
            if !self.deadline.now().is_after(arm_at) {
                return arm_at;
            }
            counts::FRAMES_LOST.add_one();
            on_frame(&Frame::lost(self.due.sequence));
            self.due.step();
        }
    }
}

/// Sets the converter up as after a reset of the chip, and switches it on. It needs 3 us until it converts (DS10314, ADC
/// characteristics); the first trigger is half a scan away.
fn reset() {
    pac::RCC.apb2rstr().modify(|w| w.set_adcrst(true));
    pac::RCC.apb2rstr().modify(|w| w.set_adcrst(false));
    // 25 MHz, of APB2's 100.
    ADC1_COMMON.ccr().modify(|w| w.set_adcpre(Adcpre::DIV4));
    pac::ADC1.cr2().modify(|w| w.set_adon(true));
}

fn listen(converter: pac::adc::Adc) {
    converter.sqr3().write_value(Sqr3(SEQUENCE[0]));
    converter.sqr2().write_value(Sqr2(SEQUENCE[1]));
    converter.sqr1().write_value(Sqr1(SEQUENCE[2] | (SCAN_LEN as u32 - 1) << LENGTH_SHIFT));
    converter.smpr1().write_value(Smpr1(SAMPLE_TIMES >> 3));
    converter.smpr2().write_value(Smpr2(SAMPLE_TIMES));
    converter.cr1().modify(|w| w.set_scan(true));
    converter.cr2().modify(|w| {
        w.set_dma(true);
        w.set_dds(Dds::CONTINUOUS);
        w.set_extsel(EXTSEL_TIM3_TRGO);
        w.set_exten(Exten::RISING_EDGE);
    });
}

/// MODER bits that make the scan's pins analogue, of ports A, B and C: two bits a pin. The converter's inputs 0 to 7 are PA0 to PA7, then come PB0
/// and PB1, and from 10 on PC0 to PC5 (DS10314, table 8).
const ANALOG: [u32; 3] = {
    let mut analog = [0; 3];
    let mut index = 0;
    while index < SCAN_LEN {
        let input = SCAN[index].adc;
        let (port, pin) = match input {
            0..8 => (0, input),
            8..10 => (1, input - 8),
            _ => (2, input - 10),
        };
        analog[port] |= 0b11 << (2 * pin);
        index += 1;
    }
    analog
};
/// SQR3, SQR2 and SQR1: six ranks of five bits in each, the first in the lowest (RM0383, section 11.12.9).
const SEQUENCE: [u32; 3] = {
    let mut sequence = [0; 3];
    let mut index = 0;
    while index < SCAN_LEN {
        sequence[index / 6] |= (SCAN[index].adc as u32) << (5 * (index % 6));
        index += 1;
    }
    sequence
};
/// Position in SQR1 of the number of ranks, less one.
const LENGTH_SHIFT: u32 = 20;
/// [`SAMPLE_TIME`] for each of the ten channels of SMPR2, three bits each. SMPR1 has nine.
const SAMPLE_TIMES: u32 = {
    let mut times = 0;
    let mut channel = 0;
    while channel < 9 {
        times |= (SAMPLE_TIME as u32) << (3 * channel);
        channel += 1;
    }
    times | (SAMPLE_TIME as u32) << 27
};
