//! Who hears what comes up the line. It never waits: what a client has no room for is dropped and counted.

use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::Tally;

pub type Frame = Arc<[u8]>;

/// Frames on their way to a client: two seconds and a half of a line at rest.
const CLIENT_FRAMES: usize = 256;

/// Every client that is there.
#[derive(Debug, Default)]
pub struct Hub {
    /// None when there is no more to come.
    clients: Mutex<Clients>,
    served: AtomicU64,
    dropped: AtomicU64,
    writers: AtomicUsize,
    closed: AtomicBool,
}

#[derive(Debug, Default)]
struct Clients {
    /// The first that each is sent, if there is any.
    greeting: Option<Frame>,
    senders: Vec<SyncSender<Frame>>,
    no_more: bool,
}

impl Hub {
    /// One that sends this to whoever comes.
    pub fn greeting(frame: &[u8]) -> Self {
        let clients = Clients { greeting: Some(Frame::from(frame)), ..Clients::default() };
        Self { clients: Mutex::new(clients), ..Self::default() }
    }

    /// A client has come: what it is to be sent, from the next frame on. It leaves by dropping this.
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

    /// Nobody is served any more.
    pub fn close(&self) {
        self.closed.store(true, Relaxed);
    }

    /// Whether nobody is served any more.
    pub fn is_closed(&self) -> bool {
        self.closed.load(Relaxed)
    }

    /// Does something that counts as writing to a client.
    pub fn writing<T>(&self, write: impl FnOnce() -> T) -> T {
        self.writers.fetch_add(1, Relaxed);
        let written = write();
        self.writers.fetch_sub(1, Relaxed);
        written
    }

    /// How many clients are written to.
    pub fn writers(&self) -> usize {
        self.writers.load(Relaxed)
    }

    pub fn tally(&self) -> Tally {
        Tally { clients: self.served.load(Relaxed), dropped: self.dropped.load(Relaxed) }
    }

    fn clients(&self) -> MutexGuard<'_, Clients> {
        // Nothing in here is ever half done.
        self.clients.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_does_not_read_loses_frames_and_who_left_is_forgotten() {
        let hub = Hub::default();
        let (reads, never_reads, left) = (hub.join(), hub.join(), hub.join());
        drop(left);
        for n in 0..CLIENT_FRAMES + 10 {
            hub.publish(&[n as u8, 0]);
            assert_eq!(reads.recv().unwrap()[0], n as u8);
        }
        assert_eq!(hub.tally(), Tally { clients: 3, dropped: 10 });
        hub.no_more();
        hub.publish(&[0]);
        assert_eq!((reads.try_iter().count(), never_reads.try_iter().count()), (0, CLIENT_FRAMES));
        assert!(hub.join().recv().is_err());
    }
}
