//! The bounded boxes between control, which never waits, and the tasks of the serial line and of the store, which do.
//! embassy's channels keep a `RefCell` inside, which is a way to panic.
//! Runs in control (2) and threads, each copy with interrupts off. Owns the boxes. Never waits on control's side.

use core::cell::Cell;
use core::future::poll_fn;
use core::mem::{MaybeUninit, forget};
use core::ptr::copy_nonoverlapping;
use core::sync::atomic::{AtomicBool, AtomicU16, Ordering::Relaxed};
use core::task::Poll;

use embassy_sync::blocking_mutex::Mutex;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;
use embassy_sync::waitqueue::AtomicWaker;
use heapless::Deque;
use tenax_hal_shim::wire::{Down, Received, Up};
use tenax_logic::allowance::BURST;
use tenax_logic::store::record::Record;

use crate::counts;
use crate::deadline::clock_us;

/// A bounded queue that nobody waits to put something into.
struct Mailbox<T, const N: usize>(Mutex<CriticalSectionRawMutex, Deque<T, N>>);

impl<T, const N: usize> Mailbox<T, N> {
    const fn new() -> Self {
        Self(Mutex::new(Deque::new()))
    }

    fn put(&self, item: T) -> bool {
        // SAFETY: the closure does not come back here.
        unsafe { self.0.lock_mut(|queue| queue.push_back(item).is_ok()) }
    }

    fn take(&self) -> Option<T> {
        // SAFETY: the closure does not come back here.
        unsafe { self.0.lock_mut(Deque::pop_front) }
    }

    /// Moves the oldest item to `place`; false if there is none. A long item that is returned is copied in odd parts, with interrupts off:
    /// control would begin its frame 7 us later.
    fn take_to(&self, place: &mut MaybeUninit<T>) -> bool {
        // SAFETY: the closure does not come back here. Of the two copies one is forgotten.
        unsafe {
            self.0.lock_mut(|queue| {
                let Some(front) = queue.front() else { return false };
                copy_nonoverlapping(front, place.as_mut_ptr(), 1);
                forget(queue.pop_front());
                true
            })
        }
    }
}

/// Messages on their way up. With everything on, eight come in a slow frame and take 11.7 of its 12.5 ms on the line; twenty events
/// may come with them at once, and an answer that takes 4 ms. What does not fit is dropped.
static TELEMETRY: Mailbox<Received<Up>, 32> = Mailbox::new();
static COUNTERS_DUE: AtomicBool = AtomicBool::new(false);
static TELEMETRY_WAKER: AtomicWaker = AtomicWaker::new();
static NEXT_SEQUENCE: AtomicU16 = AtomicU16::new(0);
static COMMANDS: Mailbox<Received<Down>, { BURST as usize }> = Mailbox::new();
static PENDING_RECORD: Mutex<CriticalSectionRawMutex, Cell<Option<Record>>> = Mutex::new(Cell::new(None));
static RECORD_IS_PENDING: AtomicBool = AtomicBool::new(false);
static STORE_WAKER: AtomicWaker = AtomicWaker::new();
/// The store waits for the end of a tick.
static TICK_WANTED: AtomicBool = AtomicBool::new(false);
/// When it ended, us.
static TICK_ENDED: Signal<CriticalSectionRawMutex, u32> = Signal::new();

/// Hands a message to telemetry, numbered. Never waits: if the line is behind, the message is dropped and counted. For control only,
/// which no other sender interrupts.
pub fn post(message: Up) {
    let sequence = NEXT_SEQUENCE.fetch_add(1, Relaxed);
    if !TELEMETRY.put(Received { sequence, message }) {
        counts::TELEMETRY_DROPPED.add_one();
    }
    TELEMETRY_WAKER.wake();
}

/// [`post`] for tasks that control interrupts: number and place are taken in one critical section. A message of control between the two
/// would overtake this one, and the receiver would count a lost message.
#[inline(never)]
pub fn post_beside_control(message: Up) {
    let mut item = Received { sequence: 0, message };
    // SAFETY: the closure does not come back here.
    let is_put = unsafe {
        TELEMETRY.0.lock_mut(|queue| {
            item.sequence = NEXT_SEQUENCE.fetch_add(1, Relaxed);
            queue.push_back(item).is_ok()
        })
    };
    if !is_put {
        counts::TELEMETRY_DROPPED.add_one();
    }
    TELEMETRY_WAKER.wake();
}

pub fn counters_due() {
    COUNTERS_DUE.store(true, Relaxed);
    TELEMETRY_WAKER.wake();
}

pub fn are_counters_due() -> bool {
    COUNTERS_DUE.swap(false, Relaxed)
}

/// Brings the oldest message posted to this place; waits for one. None: there is none and the counters are due. Not an `async fn`: one
/// that has an end can be asked again after it, which is a way to panic.
pub fn next_message(place: &mut MaybeUninit<Received<Up>>) -> impl Future<Output = Option<&Received<Up>>> {
    let mut place = Some(place);
    poll_fn(move |context| {
        TELEMETRY_WAKER.register(context.waker());
        let Some(free) = place.take() else { return Poll::Ready(None) };
        if TELEMETRY.take_to(free) {
            // SAFETY: it was put there just now.
            return Poll::Ready(Some(unsafe { free.assume_init_ref() }));
        }
        place = Some(free);
        if COUNTERS_DUE.load(Relaxed) { Poll::Ready(None) } else { Poll::Pending }
    })
}

/// Hands a command to control. Never waits: false if control has not taken the ones before.
pub fn hand_over(command: Received<Down>) -> bool {
    COMMANDS.put(command)
}

pub fn next_command() -> Option<Received<Down>> {
    COMMANDS.take()
}

pub fn store_is_free() -> bool {
    !RECORD_IS_PENDING.load(Relaxed)
}

/// Hands a record to the store. Never waits: only control does so, and only when the store is free.
pub fn save(record: Record) {
    PENDING_RECORD.lock(|cell| cell.set(Some(record)));
    RECORD_IS_PENDING.store(true, Relaxed);
    STORE_WAKER.wake();
}

pub fn next_record() -> impl Future<Output = Record> {
    poll_fn(|context| {
        STORE_WAKER.register(context.waker());
        let Some(record) = PENDING_RECORD.lock(Cell::take) else { return Poll::Pending };
        RECORD_IS_PENDING.store(false, Relaxed);
        Poll::Ready(record)
    })
}

pub fn end_tick() {
    if TICK_WANTED.load(Relaxed) {
        TICK_WANTED.store(false, Relaxed);
        TICK_ENDED.signal(clock_us());
    }
}

/// Waits for the end of the tick to come, us.
pub fn tick_over() -> impl Future<Output = u32> {
    TICK_WANTED.store(true, Relaxed);
    TICK_ENDED.wait()
}
