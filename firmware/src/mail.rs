//! The two bounded boxes between control, which never waits, and the tasks of the serial line, which do.

use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use tenax_hal_shim::wire::{Down, Received, Up};

use crate::counts;

/// Messages on their way up. A slow frame comes every 12.5 ms and takes 2 ms on the line, so this holds a burst of
/// events and an answer or two; what does not fit is dropped.
static UP: Channel<CriticalSectionRawMutex, Up, 16> = Channel::new();
/// Commands on their way to control.
static DOWN: Channel<CriticalSectionRawMutex, Received<Down>, 8> = Channel::new();

/// Hands a message to telemetry. Never waits: if the line is behind, the message is dropped and counted.
pub fn post(message: Up) {
    if UP.try_send(message).is_err() {
        counts::TELEMETRY_DROPPED.add_one();
    }
}

/// The oldest message posted; waits for one.
pub async fn next_message() -> Up {
    UP.receive().await
}

/// Hands a command to control; waits while control has not taken the ones before.
pub async fn hand_over(command: Received<Down>) {
    DOWN.send(command).await;
}

/// The oldest command that control has not taken. Never waits.
pub fn next_command() -> Option<Received<Down>> {
    DOWN.try_receive().ok()
}
