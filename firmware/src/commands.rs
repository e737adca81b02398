//! The commands task: bytes come down the serial line, commands go to control. Anything else is counted and skipped, and so
//! is what comes faster than an [`Allowance`], before its CRC is looked at.

use embassy_stm32::usart::RingBufferedUartRx;
use tenax_hal_shim::wire::{BadFrame, Down, Receiver};
use tenax_logic::allowance::Allowance;

use crate::{counts, mail};

/// Bytes that DMA writes around in: 11 ms of a full line, and this task needs far less to get its turn.
pub const RING_LEN: usize = 1024;

/// Listens for ever.
#[embassy_executor::task]
pub async fn commands(mut line: RingBufferedUartRx<'static>) -> ! {
    let mut receiver = Receiver::new();
    let mut allowance = Allowance::default();
    let mut bytes = [0; 64];
    loop {
        // After an error of the line the next read starts it anew; the frame it fell into fails its CRC.
        let Ok(count) = line.read(&mut bytes).await else {
            counts::BAD_FRAMES.add_one();
            continue;
        };
        for &byte in bytes.iter().take(count) {
            take(&mut receiver, &mut allowance, byte);
        }
    }
}

/// Takes a byte of a line. Not inlined: there are two lines.
#[inline(never)]
pub fn take(receiver: &mut Receiver, allowance: &mut Allowance, byte: u8) {
    match receiver.push_if::<Down>(byte, || allowance.admits(counts::last_frame())) {
        None => {}
        // Never waits: while it did, bytes that came would be lost in the middle of a frame.
        Some(Ok(command)) if allowance.affords(&command.message) && mail::hand_over(command) => {}
        Some(Ok(_) | Err(BadFrame::Skipped)) => counts::COMMANDS_SKIPPED.add_one(),
        Some(Err(_)) => counts::BAD_FRAMES.add_one(),
    }
}
