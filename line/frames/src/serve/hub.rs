//! Clients of a line: each gets the frames that come up, and theirs go down. What a client has no room for is dropped and counted.

use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use anyhow::Context;
use tenax_hal_shim::wire::FRAME_MAX;

use super::Tally;
use crate::link::is_silence;

pub type Frame = Arc<[u8]>;

/// Frames on their way to a client: 2.5 s of a line at rest.
const CLIENT_FRAMES: usize = 256;
const LOOK_EVERY: Duration = Duration::from_millis(10);
const TIMEOUT: Duration = Duration::from_millis(100);

pub struct Hub {
    clients: Mutex<Clients>,
    writers: AtomicUsize,
    closed: AtomicBool,
    down: SyncSender<Vec<u8>>,
}

#[derive(Default)]
struct Clients {
    senders: Option<Vec<SyncSender<Frame>>>,
    tally: Tally,
}

impl Hub {
    pub fn new(down: SyncSender<Vec<u8>>) -> Arc<Self> {
        let clients = Mutex::new(Clients { senders: Some(Vec::new()), ..Clients::default() });
        let (writers, closed) = (AtomicUsize::default(), AtomicBool::default());
        Arc::new(Self { clients, writers, closed, down })
    }

    /// Adds a client: its frames, from the next one on. It leaves by dropping them.
    pub fn join(&self) -> Receiver<Frame> {
        let (sender, frames) = sync_channel(CLIENT_FRAMES);
        let Clients { senders: Some(senders), tally } = &mut *self.clients() else { return frames };
        tally.clients += 1;
        senders.push(sender);
        frames
    }

    pub fn publish(&self, frame: &[u8]) {
        let Clients { senders: Some(senders), tally } = &mut *self.clients() else { return };
        let frame = Frame::from(frame);
        senders.retain(|sender| {
            let sent = sender.try_send(Arc::clone(&frame));
            tally.dropped += u64::from(matches!(sent, Err(TrySendError::Full(_))));
            !matches!(sent, Err(TrySendError::Disconnected(_)))
        });
    }

    /// The line is over. Ends when every client has read what is on its way, or the time is over.
    pub fn close(&self, within: Duration) {
        self.clients().senders = None;
        let began = Instant::now();
        while self.writers.load(Relaxed) > 0 && began.elapsed() < within {
            thread::sleep(Duration::from_millis(5));
        }
        self.closed.store(true, Relaxed);
    }

    pub fn is_closed(&self) -> bool {
        self.closed.load(Relaxed)
    }

    pub fn tally(&self) -> Tally {
        self.clients().tally
    }

    /// Sends frames to a client until there are no more, or it is `gone`. A timeout is no error: the end of the run is noticed then.
    pub fn write(&self, frames: &Receiver<Frame>, client: &mut dyn Write, gone: &AtomicBool) {
        self.writers.fetch_add(1, Relaxed);
        let mut write = |frame: Frame| {
            let mut rest = &frame[..];
            while !rest.is_empty() {
                // Before each write: the next client of a pseudo-terminal would hear the frame twice.
                if gone.load(Relaxed) {
                    return None;
                }
                match client.write(rest) {
                    Ok(count @ 1..) => rest = &rest[count..],
                    Err(error) if is_silence(&error) && !self.is_closed() => {}
                    _ => return None,
                }
            }
            Some(())
        };
        let _left = frames.iter().try_for_each(&mut write);
        self.writers.fetch_sub(1, Relaxed);
    }

    pub fn read(&self, client: &mut dyn Read) {
        let (mut framer, mut buffer) = (Framer::default(), [0; 4096]);
        while !self.is_closed() {
            match client.read(&mut buffer) {
                Ok(count @ 1..) => self.pass_on(&mut framer, &buffer[..count]),
                Err(error) if is_silence(&error) => {}
                _ => break,
            }
        }
    }

    /// Passes bytes on down the line; waits while the board has not taken those before.
    pub fn pass_on(&self, framer: &mut Framer, bytes: &[u8]) {
        for mut frame in bytes.iter().filter_map(|&byte| framer.push(byte)) {
            while let Err(TrySendError::Full(back)) = self.down.try_send(frame) {
                if self.is_closed() {
                    return;
                }
                frame = back;
                thread::sleep(Duration::from_millis(1));
            }
        }
    }

    /// Serves on 127.0.0.1 until the hub is closed; the address for `tenax monitor --port`. No other machine may reach the line: it can
    /// drive the motor.
    pub fn serve_tcp(self: &Arc<Self>, port: u16) -> anyhow::Result<(String, JoinHandle<()>)> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).with_context(|| {
            format!("cannot serve on TCP port {port}: choose another, or 0 for any that is free")
        })?;
        listener.set_nonblocking(true)?;
        let (place, hub) = (format!("tcp:{}", listener.local_addr()?), Arc::clone(self));
        let door = thread::spawn(move || {
            while !hub.is_closed() {
                match listener.accept() {
                    Ok((stream, _)) => drop(hub.attend(stream)),
                    Err(_) => thread::sleep(LOOK_EVERY),
                }
            }
        });
        Ok((place, door))
    }

    fn attend(self: &Arc<Self>, mut stream: TcpStream) -> io::Result<()> {
        stream.set_nonblocking(false)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(TIMEOUT))?;
        stream.set_write_timeout(Some(TIMEOUT))?;
        let (mut up, frames) = (stream.try_clone()?, self.join());
        let (writer, reader) = (Arc::clone(self), Arc::clone(self));
        thread::spawn(move || {
            writer.write(&frames, &mut up, &AtomicBool::default());
            // The reader's thread has the stream too, so it is not closed by itself.
            let _closed = up.shutdown(Shutdown::Both);
        });
        thread::spawn(move || reader.read(&mut stream));
        Ok(())
    }

    fn clients(&self) -> MutexGuard<'_, Clients> {
        self.clients.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Cuts a stream of bytes into frames, each of which ends with a zero.
#[derive(Default)]
pub struct Framer(Vec<u8>);

impl Framer {
    /// Takes a byte; gives the frame that it ends. Of one that is too long to be any, as much as shows that.
    pub fn push(&mut self, byte: u8) -> Option<Vec<u8>> {
        if byte == 0 || self.0.len() <= FRAME_MAX {
            self.0.push(byte);
        }
        (byte == 0).then(|| std::mem::take(&mut self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_end_with_their_zero_and_none_grows_for_ever() {
        let mut framer = Framer::default();
        let frames: Vec<_> = [1, 2, 0, 0].iter().filter_map(|&byte| framer.push(byte)).collect();
        assert_eq!(frames, [vec![1, 2, 0], vec![0]]);
        (0..1 << 20).for_each(|_| assert_eq!(framer.push(7), None));
        assert_eq!(framer.push(0).unwrap().len(), FRAME_MAX + 2);
    }
}
