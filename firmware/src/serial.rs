//! The serial line of the ST-LINK, USART2 through embassy's driver: messages go up as fast as it takes them, commands come down to control.
//! Runs in thread; its handlers are embassy's (6). Owns USART2, PA2, PA3, DMA1's streams 5 and 6. May panic, which resets; never moves the motor.

use core::mem::MaybeUninit;

use embassy_futures::poll_once;
use embassy_stm32::gpio::Pull;
use embassy_stm32::mode::Async;
use embassy_stm32::peripherals::{DMA1_CH5, DMA1_CH6, PA2, PA3, USART2};
use embassy_stm32::usart::{Config, RingBufferedUartRx, Uart, UartTx};
use embassy_stm32::{Peri, bind_interrupts, dma, usart};
use static_cell::ConstStaticCell;
use tenax_hal_shim::wire::{BAUD, BadFrame, Down, FRAME_MAX, Received, Receiver, Up, encode};
use tenax_logic::allowance::Allowance;

use crate::deadline::clock_us;
use crate::timing::RING_LEN;
use crate::{black_box, counts, log, mail};

bind_interrupts!(struct Irqs {
    USART2 => usart::InterruptHandler<USART2>;
    DMA1_STREAM5 => dma::InterruptHandler<DMA1_CH5>;
    DMA1_STREAM6 => dma::InterruptHandler<DMA1_CH6>;
});

static RING: ConstStaticCell<[u8; RING_LEN]> = ConstStaticCell::new([0; RING_LEN]);

pub type UpLine = UartTx<'static, Async>;
pub type DownLine = RingBufferedUartRx<'static>;

pub fn open(
    port: Peri<'static, USART2>,
    (rx, tx): (Peri<'static, PA3>, Peri<'static, PA2>),
    (rx_dma, tx_dma): (Peri<'static, DMA1_CH5>, Peri<'static, DMA1_CH6>),
) -> (UpLine, DownLine) {
    let mut config = Config::default();
    config.baudrate = BAUD;
    // Nobody may be at the other end.
    config.rx_pull = Pull::Up;
    let port = Uart::new(port, rx, tx, tx_dma, rx_dma, Irqs, config).expect("a rate that APB1 reaches");
    let (up, down) = port.split();
    let mut down = down.into_ring_buffered(RING.take());
    // What comes before somebody reads is kept.
    down.start_uart();
    (up, down)
}

/// Hands commands to control. Anything else is counted and skipped, and so is what comes faster than an [`Allowance`], before its CRC
/// is looked at.
#[embassy_executor::task]
pub async fn commands(mut line: DownLine) -> ! {
    let mut receiver = Receiver::new();
    let mut allowance = Allowance::default();
    let mut bytes = [0; 64];
    loop {
        // The frame that lost bytes fails its CRC.
        let Ok(count) = line.read(&mut bytes).await else {
            counts::BAD_FRAMES.add_one();
            // Restarted, DMA begins anew at the ring's start (RM0383, section 9.5.6; embassy-rs/embassy#6592 saw it go on), and embassy,
            // which clears nothing since #3541, takes all that lies behind for new: commands that were carried out. They are there at once,
            // and what comes now is not.
            while poll_once(line.read(&mut bytes)).is_ready() {}
            continue;
        };
        for &byte in bytes.iter().take(count) {
            match receiver.push_if::<Down>(byte, || allowance.admits(counts::last_frame())) {
                None => {}
                // Never waits: while it did, bytes that came would be lost in the middle of a frame.
                Some(Ok(command)) if allowance.affords(&command.message) && mail::hand_over(command) => {}
                Some(Ok(_) | Err(BadFrame::Skipped)) => counts::COMMANDS_SKIPPED.add_one(),
                Some(Err(_)) => counts::BAD_FRAMES.add_one(),
            }
        }
    }
}

static NEXT: ConstStaticCell<MaybeUninit<Received<Up>>> = ConstStaticCell::new(MaybeUninit::uninit());

/// Sends what is posted, in its order, and posts the counters ten times a second.
#[embassy_executor::task]
pub async fn telemetry(mut line: UpLine) -> ! {
    // Ends the frame that a reset may have cut short, so that the hello is not taken for the rest of it.
    let _never_fails = line.write(&[0]).await;
    let mut share = Share::new();
    let mut buffer = [0; FRAME_MAX];
    let next = NEXT.take();
    loop {
        let posted = mail::next_message(next).await;
        // Behind a message that was taken: a line that is behind has a place free for them now, and at no other time.
        if mail::are_counters_due() {
            mail::post_beside_control(Up::Counters(counts::counters(share.permille())));
        }
        let Some(posted) = posted else { continue };
        match encode(posted.sequence, &posted.message, &mut buffer) {
            Some(frame) => {
                black_box::write(&posted.message, frame);
                log::told(&posted.message);
                let _never_fails = line.write(frame).await;
            }
            None => counts::TELEMETRY_DROPPED.add_one(),
        }
    }
}

struct Share {
    at_us: u32,
    control_us: u32,
}

impl Share {
    fn new() -> Self {
        Self { at_us: clock_us(), control_us: counts::control_us() }
    }

    /// Since it was last asked, per mille.
    fn permille(&mut self) -> u16 {
        let last = core::mem::replace(self, Self::new());
        let lasted_us = self.at_us.wrapping_sub(last.at_us);
        let control_us = self.control_us.wrapping_sub(last.control_us);
        // Far below 2^32: the counters are due ten times a second.
        (control_us.saturating_mul(1_000) / lasted_us.max(1)).min(1_000) as u16
    }
}
