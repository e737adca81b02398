//! Distributes frames to clients. It never waits: what a client has no room for is dropped and counted.

use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::Tally;

pub type Frame = Arc<[u8]>;

/// Frames on their way to a client: two seconds and a half of a line at rest.
const CLIENT_FRAMES: usize = 256;

/// The clients that are there.
#[derive(Debug, Default)]
pub struct Hub {
    clients: Mutex<Clients>,
    served: AtomicU64,
    dropped: AtomicU64,
    writers: AtomicUsize,
    closed: AtomicBool,
}

#[derive(Debug, Default)]
struct Clients {
    /// The first frame for each client.
    greeting: Option<Frame>,
    senders: Vec<SyncSender<Frame>>,
    no_more: bool,
}

impl Hub {
    pub fn greeting(frame: &[u8]) -> Self {
        let clients = Clients { greeting: Some(Frame::from(frame)), ..Clients::default() };
        Self { clients: Mutex::new(clients), ..Self::default() }
    }

    /// Adds a client: its frames, from the next one on. It leaves by dropping them.
    pub fn join(&self) -> Receiver<Frame> {
        let (sender, frames) = sync_channel(CLIENT_FRAMES);
        let mut clients = self.clients();
        if !clients.no_more {
            if let Some(greeting) = &clients.greeting {
                // There is room.
                let _sent = sender.try_send(Arc::clone(greeting));
            }
            clients.senders.push(sender);
            self.served.fetch_add(1, Relaxed);
        }
        frames
    }

    pub fn publish(&self, frame: &[u8]) {
        let mut clients = self.clients();
        if clients.senders.is_empty() {
            return;
        }
        let frame = Frame::from(frame);
        clients.senders.retain(|sender| match sender.try_send(Arc::clone(&frame)) {
            Ok(()) => true,
            Err(TrySendError::Full(_)) => {
                self.dropped.fetch_add(1, Relaxed);
                true
            }
            Err(TrySendError::Disconnected(_)) => false,
        });
    }

    /// The line is over; clients get what is on its way.
    pub fn no_more(&self) {
        let mut clients = self.clients();
        clients.no_more = true;
        clients.senders.clear();
    }

    pub fn close(&self) {
        self.closed.store(true, Relaxed);
    }

    pub fn is_closed(&self) -> bool {
        self.closed.load(Relaxed)
    }

    /// Counts `write` among the [`writers`](Self::writers) until it returns.
    pub fn writing<T>(&self, write: impl FnOnce() -> T) -> T {
        self.writers.fetch_add(1, Relaxed);
        let written = write();
        self.writers.fetch_sub(1, Relaxed);
        written
    }

    pub fn writers(&self) -> usize {
        self.writers.load(Relaxed)
    }

    pub fn tally(&self) -> Tally {
        Tally { clients: self.served.load(Relaxed), dropped: self.dropped.load(Relaxed) }
    }

    fn clients(&self) -> MutexGuard<'_, Clients> {
        self.clients.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
