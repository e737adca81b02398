//! The telemetry task: messages go up the serial line, as fast as it takes them.

use embassy_futures::select::{Either, select};
use embassy_stm32::mode::Async;
use embassy_stm32::usart::UartTx;
use embassy_time::{Duration, Ticker};
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::wire::{FRAME_MAX, Up, encode};
use tenax_hal_shim::words::Fault;

use crate::{counts, mail};

const COUNTERS_PERIOD: Duration = Duration::from_hz(10);

/// Says hello, then sends what is posted and the counters ten times a second.
#[embassy_executor::task]
pub async fn telemetry(mut line: UartTx<'static, Async>, after: Option<Fault>) -> ! {
    // Ends the frame that a reset may have cut short, so that the hello is not taken for the rest of it.
    let _gone = line.write(&[0]).await;
    let mut counters_due = Ticker::every(COUNTERS_PERIOD);
    let mut message = Up::Hello { frame_hz: FRAME_HZ as u16, after };
    let mut sequence = 0u16;
    let mut buffer = [0; FRAME_MAX];
    loop {
        match encode(sequence, &message, &mut buffer) {
            // An error of the line shows as a gap in the sequence numbers at its other end.
            Some(frame) => {
                if line.write(frame).await.is_err() {
                    counts::TELEMETRY_DROPPED.add_one();
                }
            }
            None => counts::TELEMETRY_DROPPED.add_one(),
        }
        sequence = sequence.wrapping_add(1);
        message = match select(counters_due.next(), mail::next_message()).await {
            Either::First(()) => Up::Counters(counts::counters()),
            Either::Second(message) => message,
        };
    }
}
