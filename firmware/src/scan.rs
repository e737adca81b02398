//! The 14-channel scan: TIM3 starts it in hardware 8000 times a second, DMA carries it, one interrupt a frame.
//!
//! embassy's own ring-buffered converter cannot do this: it writes every rank into SQR3, which holds six; it never looks
//! at OVR, after which the converter is silent for ever; and it starts one scan by software ahead of the first timed one.
//! So the sequence is written here, through the PAC, and so is its DMA ([`halves`](crate::halves)).
//!
//! The scan's timer and the deadline's count the same clock, so the two never drift apart and the instant of every
//! frame is known without asking the converter: a frame that does not come in time is lost, and after a restart the
//! sequence numbers go on where time has got to.

use embassy_stm32::Peri;
use embassy_stm32::adc::{Adc, AnyAdcChannel};
use embassy_stm32::pac;
use embassy_stm32::pac::adc::vals::{Dds, Exten, SampleTime};
use embassy_stm32::peripherals::{ADC1, DMA2_CH0, TIM3};
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::low_level::{MasterMode, RoundTo, Timer as HardwareTimer};
use tenax_hal_shim::channel::{FRAME_HZ, SCAN, SCAN_HZ, SCAN_LEN};
use tenax_hal_shim::frame::Frame;

use crate::counts;
use crate::deadline::{Deadline, Micros};
use crate::halves::{Halves, RING_LEN};

const SCAN_US: u32 = 1_000_000 / SCAN_HZ;
const FRAME_US: u32 = 1_000_000 / FRAME_HZ;
/// EXTSEL of the regular group: TIM3's TRGO (RM0383, section 11.12.3).
const EXTSEL_TIM3_TRGO: u8 = 0b1000;
/// 56 + 12 cycles at 25 MHz: a scan takes 38 us of its 125, and sources of up to 20 kohm settle (DS10314, equation 1).
const SAMPLE_TIME: SampleTime = SampleTime::CYCLES56;
/// A frame that is this late is not waited for any more, us: the switches have begun to show the following one.
const PATIENCE_US: u32 = SCAN_US;

/// Why a recording ended.
#[derive(defmt::Format)]
enum Trouble {
    /// The converter had a code that DMA did not fetch (OVR); its requests have stopped.
    Overrun,
    /// A frame did not come in time.
    Silent,
    /// A frame was read only after the following one had begun, or DMA was in it when it was read.
    Behind,
}

/// The converter, its timer and its DMA.
pub struct Scan {
    adc: Peri<'static, ADC1>,
    stream: Peri<'static, DMA2_CH0>,
    ring: &'static mut [u32; RING_LEN],
    timer: HardwareTimer<'static, TIM3>,
    deadline: Deadline,
    due: Due,
}

/// The frame to come.
struct Due {
    sequence: u32,
    /// When its first scan is triggered.
    begins: Micros,
}

impl Due {
    fn step(&mut self) {
        self.sequence = self.sequence.wrapping_add(1);
        self.begins = self.begins.after(FRAME_US);
    }
}

impl Scan {
    /// Takes the hardware; nothing is converted before [`run`](Self::run).
    ///
    /// `pins` are proof that nobody else uses them, and must be those of the channel map.
    pub fn new(
        adc: Peri<'static, ADC1>,
        timer: Peri<'static, TIM3>,
        stream: Peri<'static, DMA2_CH0>,
        ring: &'static mut [u32; RING_LEN],
        deadline: Deadline,
        pins: [AnyAdcChannel<'static, ADC1>; SCAN_LEN],
    ) -> Self {
        for (pin, rank) in pins.iter().zip(&SCAN) {
            assert!(pin.get_hw_channel() == rank.adc, "{} is not wired as the channel map says", rank.pin);
        }
        let timer = HardwareTimer::new(timer);
        timer.set_frequency(Hertz(SCAN_HZ), RoundTo::Faster);
        timer.set_master_mode(MasterMode::UPDATE);
        let due = Due { sequence: 0, begins: deadline.now() };
        Self { adc, stream, ring, timer, deadline, due }
    }

    /// Hands every frame to `on_frame` as soon as its last code has been converted, for ever. Frames that are lost are
    /// handed over as such, so that whoever counts time by frames keeps time.
    ///
    /// `on_frame` has until the next frame begins, 87 us, to step the switches for it.
    pub async fn run(mut self, mut on_frame: impl FnMut(&Frame)) -> ! {
        self.timer.start();
        // The first trigger comes one period after the start.
        self.due.begins = self.deadline.now().after(SCAN_US);
        loop {
            self.catch_up(&mut on_frame).await;
            let trouble = self.record(&mut on_frame).await;
            counts::OVERRUNS.add_one();
            defmt::warn!("scan: {} at frame {}, restarting", trouble, self.due.sequence);
        }
    }

    /// Gives up the frames that have begun, and waits until the scan before the next one has been triggered.
    async fn catch_up(&mut self, on_frame: &mut impl FnMut(&Frame)) {
        loop {
            let arm_at = self.due.begins.before(SCAN_US / 2);
            if !self.deadline.now().is_after(arm_at) {
                let never = || None::<()>;
                self.deadline.until(arm_at, never).await;
                return;
            }
            counts::FRAMES_LOST.add_one();
            on_frame(&Frame::lost(self.due.sequence));
            self.due.step();
        }
    }

    /// Sets the converter and its DMA up from reset, and hands over frames until something goes wrong.
    async fn record(&mut self, on_frame: &mut impl FnMut(&Frame)) -> Trouble {
        let Self { adc, stream, ring, deadline, due, .. } = self;
        // Resets the converter: whatever it was doing is over.
        let _adc = Adc::new(adc.reborrow());
        let converter = pac::ADC1;
        let mut halves = Halves::start(stream.reborrow(), ring, converter.dr().as_ptr().cast());
        listen(converter);

        loop {
            let following_begins = due.begins.after(FRAME_US);
            let filled = || halves.is_filled().then_some(());
            if deadline.until(following_begins.after(PATIENCE_US), filled).await.is_none() {
                return if converter.sr().read().ovr() { Trouble::Overrun } else { Trouble::Silent };
            }
            let Ok(frame) = halves.read(due.sequence) else { return Trouble::Behind };
            // Then the switches do not show yet what the following frame is reading.
            let began = deadline.now();
            let behind = began.is_after(following_begins);
            on_frame(&frame);
            counts::FRAMES.add_one();
            let ended = deadline.now();
            counts::CONTROL_US.add(ended.since(began));
            counts::CONTROL_US_MAX.max(ended.since(began));
            if ended.is_after(following_begins) {
                counts::TICKS_LATE.add_one();
            }
            due.step();
            if behind {
                return Trouble::Behind;
            }
        }
    }
}

/// Lets TIM3 trigger scans of all ranks.
fn listen(converter: pac::adc::Adc) {
    converter.sqr1().modify(|w| w.set_l(SCAN_LEN as u8 - 1));
    for (index, rank) in SCAN.iter().enumerate() {
        match index {
            0..=5 => converter.sqr3().modify(|w| w.set_sq(index, rank.adc)),
            6..=11 => converter.sqr2().modify(|w| w.set_sq(index - 6, rank.adc)),
            _ => converter.sqr1().modify(|w| w.set_sq(index - 12, rank.adc)),
        }
        let channel = usize::from(rank.adc);
        match channel {
            0..=9 => converter.smpr2().modify(|w| w.set_smp(channel, SAMPLE_TIME)),
            _ => converter.smpr1().modify(|w| w.set_smp(channel - 10, SAMPLE_TIME)),
        }
    }
    converter.cr1().modify(|w| w.set_scan(true));
    converter.cr2().modify(|w| {
        w.set_dma(true);
        w.set_dds(Dds::CONTINUOUS);
        w.set_extsel(EXTSEL_TIM3_TRGO);
        w.set_exten(Exten::RISING_EDGE);
    });
}
