//! The two directions of one client's connection, each on a thread that may wait as long as the client likes.

use std::io::{self, ErrorKind, Read, Write};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError};
use std::thread;
use std::time::Duration;

use super::framer::Framer;
use super::hub::{Frame, Hub};
use crate::link::is_silence;

/// Both ends of the board's line.
#[derive(Clone)]
pub struct Ends {
    /// What comes up.
    pub hub: Arc<Hub>,
    /// What goes down, frame by frame.
    pub down: SyncSender<Vec<u8>>,
    /// What a frame that goes down ends with.
    pub end: u8,
}

impl Ends {
    /// Sends frames to a client until there are no more, or it has left. A timeout of its `Write` is no error: it only
    /// has the end of the run noticed.
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

    /// Passes on what a client sends until it leaves or nobody is served any more.
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
