//! The commands task: bytes come down the serial line, commands go to control. Anything else is counted and skipped, and so
//! is what comes faster than an [`Allowance`], before its CRC is looked at.

use tenax_hal_shim::wire::{BadFrame, Down, Receiver};
use tenax_logic::allowance::Allowance;

use crate::{counts, line, mail};

#[embassy_executor::task]
pub async fn commands(mut line: line::Down) -> ! {
    let mut receiver = Receiver::new();
    let mut allowance = Allowance::default();
    let mut bytes = [0; 64];
    loop {
        // The frame that lost bytes fails its CRC.
        let Ok(count) = line.read(&mut bytes).await else {
            counts::BAD_FRAMES.add_one();
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
