//! The bounded boxes between control, which never waits, and the tasks of the serial line and of the store, which do.

use core::sync::atomic::{AtomicBool, AtomicU16, Ordering::Relaxed};

use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use embassy_sync::signal::Signal;
use tenax_hal_shim::wire::{Down, Received, Up};
use tenax_logic::allowance::BURST;
use tenax_logic::store::record::Record;

use crate::counts;

/// Messages on their way up. A slow frame comes every 12.5 ms and takes 2 ms on the line, so this holds a burst of
/// events and an answer or two; what does not fit is dropped.
static UP: Channel<CriticalSectionRawMutex, Received<Up>, 16> = Channel::new();
/// Number of the next message.
static NUMBER: AtomicU16 = AtomicU16::new(0);
/// Commands on their way to control.
static DOWN: Channel<CriticalSectionRawMutex, Received<Down>, { BURST as usize }> = Channel::new();
/// A record on its way to flash.
static RECORD: Channel<CriticalSectionRawMutex, Record, 1> = Channel::new();
/// Control has just ended a tick; signalled only while the store waits for one.
static TICK: Signal<CriticalSectionRawMutex, ()> = Signal::new();
static TICK_WANTED: AtomicBool = AtomicBool::new(false);

/// Hands a message to telemetry, numbered. Never waits: if the line is behind, the message is dropped and counted, and the
/// other end sees the gap in the numbers.
pub fn post(message: Up) {
    let sequence = NUMBER.fetch_add(1, Relaxed);
    if UP.try_send(Received { sequence, message }).is_err() {
        counts::TELEMETRY_DROPPED.add_one();
    }
}

/// The oldest message posted; waits for one.
pub async fn next_message() -> Received<Up> {
    UP.receive().await
}

/// Hands a command to control. Never waits: false if control has not taken the ones before, and no more than are earned
/// at once fit anyway.
pub fn hand_over(command: Received<Down>) -> bool {
    DOWN.try_send(command).is_ok()
}

/// The oldest command that control has not taken. Never waits.
pub fn next_command() -> Option<Received<Down>> {
    DOWN.try_receive().ok()
}

/// Whether the store would take a record.
pub fn store_is_free() -> bool {
    RECORD.is_empty()
}

/// Hands a record to the store. Never waits: only control does so, and only when the store is free.
pub fn save(record: Record) {
    let _taken = RECORD.try_send(record);
}

/// The next record to save; waits for one.
pub async fn next_record() -> Record {
    RECORD.receive().await
}

/// Says that a tick has ended, if anybody waits for it.
pub fn end_tick() {
    if TICK_WANTED.load(Relaxed) {
        TICK.signal(());
    }
}

/// Waits for the end of the tick to come.
pub async fn tick_over() {
    TICK.reset();
    TICK_WANTED.store(true, Relaxed);
    TICK.wait().await;
    TICK_WANTED.store(false, Relaxed);
}
