//! The telemetry task: messages go up the serial line, as fast as it takes them.

use core::mem::MaybeUninit;

use embassy_futures::select::{Either, select};
use embassy_stm32::mode::Async;
use embassy_stm32::usart::UartTx;
use embassy_time::{Duration, Instant, Ticker};
use static_cell::ConstStaticCell;
use tenax_hal_shim::wire::{FRAME_MAX, Received, Up, encode};

use crate::{black_box, bus, counts, mail};

const COUNTERS_PERIOD: Duration = Duration::from_hz(10);

/// The message that is being sent.
static NEXT: ConstStaticCell<MaybeUninit<Received<Up>>> = ConstStaticCell::new(MaybeUninit::uninit());

/// Sends what is posted, in its order, and posts the counters ten times a second.
#[embassy_executor::task]
pub async fn telemetry(mut line: UartTx<'static, Async>) -> ! {
    // Ends the frame that a reset may have cut short, so that the hello is not taken for the rest of it.
    let _gone = line.write(&[0]).await;
    let mut counters_due = Ticker::every(COUNTERS_PERIOD);
    let mut share = Share::new();
    let mut buffer = [0; FRAME_MAX];
    let next = NEXT.take();
    loop {
        let posted = match select(counters_due.next(), mail::next_message(next)).await {
            Either::First(()) => {
                mail::post_beside_control(Up::Counters(counts::counters(share.permille())));
                continue;
            }
            Either::Second(posted) => posted,
        };
        match encode(posted.sequence, &posted.message, &mut buffer) {
            // An error of the line shows as a gap in the numbers at its other end.
            Some(frame) => {
                black_box::write(&posted.message, frame);
                bus::said(posted, frame);
                if line.write(frame).await.is_err() {
                    counts::TELEMETRY_DROPPED.add_one();
                }
            }
            None => counts::TELEMETRY_DROPPED.add_one(),
        }
    }
}

/// Control's part of the core's time.
struct Share {
    at: Instant,
    control_us: u32,
}

impl Share {
    fn new() -> Self {
        Self { at: Instant::now(), control_us: counts::control_us() }
    }

    /// Since it was last asked, per mille.
    fn permille(&mut self) -> u16 {
        let last = core::mem::replace(self, Self::new());
        let lasted_us = (self.at - last.at).as_micros() as u32;
        let control_us = self.control_us.wrapping_sub(last.control_us);
        // Far below 2^32: the counters are due ten times a second.
        (control_us.saturating_mul(1_000) / lasted_us.max(1)).min(1_000) as u16
    }
}
