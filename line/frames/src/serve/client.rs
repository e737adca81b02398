//! The two directions of one client's connection, each on a thread that may wait as long as the client likes.

use std::io::{self, ErrorKind, Read, Write};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError};
use std::thread;
use std::time::Duration;

use tenax_hal_shim::wire::FRAME_MAX;

use super::hub::{Frame, Hub};
use crate::link::is_silence;

/// Cuts a stream of bytes after each `end`: into frames, or into lines.
#[derive(Debug, Default)]
pub struct Framer {
    bytes: Vec<u8>,
    end: u8,
}

impl Framer {
    pub const fn ending(end: u8) -> Self {
        Self { bytes: Vec::new(), end }
    }

    /// Takes a byte; gives the frame that it ends. Of one that is too long to be any, as much as shows that.
    pub fn push(&mut self, byte: u8) -> Option<Vec<u8>> {
        if byte == self.end || self.bytes.len() <= FRAME_MAX {
            self.bytes.push(byte);
        }
        (byte == self.end).then(|| std::mem::take(&mut self.bytes))
    }
}

/// Both ends of the board's line.
#[derive(Clone)]
pub struct Ends {
    pub hub: Arc<Hub>,
    /// Frames that go down.
    pub down: SyncSender<Vec<u8>>,
    /// The byte that ends a frame that goes down.
    pub end: u8,
}

impl Ends {
    /// Sends frames to a client until there are no more, or it has left. A timeout of its `Write` is no error: the end of the
    /// run is noticed then.
    pub fn write(&self, frames: &Receiver<Frame>, client: &mut dyn Write) -> io::Result<()> {
        self.hub.writing(|| {
            for frame in frames {
                let mut rest = &frame[..];
                while !rest.is_empty() {
                    match client.write(rest) {
                        Ok(0) => return Err(ErrorKind::WriteZero.into()),
                        Ok(count) => rest = &rest[count..],
                        Err(error) if is_silence(&error) && !self.hub.is_closed() => {}
                        Err(error) => return Err(error),
                    }
                }
            }
            Ok(())
        })
    }

    /// Passes on what a client sends until it leaves or the hub is closed.
    pub fn read(&self, client: &mut dyn Read) -> io::Result<()> {
        let (mut framer, mut buffer) = (Framer::ending(self.end), [0; 4096]);
        while !self.hub.is_closed() {
            match client.read(&mut buffer) {
                Ok(0) => break,
                Ok(count) => self.pass_on(&mut framer, &buffer[..count]),
                Err(error) if is_silence(&error) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// Passes bytes on down the line; waits while the board has not taken those before.
    pub fn pass_on(&self, framer: &mut Framer, bytes: &[u8]) {
        for mut frame in bytes.iter().filter_map(|&byte| framer.push(byte)) {
            while let Err(TrySendError::Full(back)) = self.down.try_send(frame) {
                if self.hub.is_closed() {
                    return;
                }
                frame = back;
                thread::sleep(Duration::from_millis(1));
            }
        }
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
