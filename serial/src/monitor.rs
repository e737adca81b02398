//! A board's serial line for people: one line a message, what is missing counted, whatever comes.

pub mod app;
pub mod screen;
pub mod source;
pub mod view;

use std::io::{self, Read, Write};

use tenax_hal_shim::wire::BadFrame;

use crate::link::{Counts, Heard, Inbox, is_silence};

use crate::words::{Words, why};

/// What has been heard so far.
#[derive(Debug, Default)]
pub struct Monitor {
    inbox: Inbox,
}

impl Monitor {
    /// Takes bytes as they come and prints what they say.
    pub fn take(&mut self, bytes: &[u8], out: &mut dyn Write) -> io::Result<()> {
        for &byte in bytes {
            if let Some(frame) = self.inbox.push(byte) {
                print(&frame, out)?;
            }
        }
        Ok(())
    }

    /// What has been counted.
    pub fn counts(&self) -> Counts {
        self.inbox.counts()
    }

    /// Reads until the source ends, printing as it goes. Silence is waited out; an end says why it ended.
    pub fn watch(&mut self, source: &mut dyn Read, out: &mut dyn Write) -> io::Result<End> {
        let mut buffer = [0; 4096];
        loop {
            match source.read(&mut buffer) {
                Ok(0) => return Ok(End::Over),
                Ok(length) => {
                    self.take(&buffer[..length], out)?;
                    out.flush()?;
                }
                Err(error) if is_silence(&error) => {}
                Err(error) => return Ok(End::Unplugged(error)),
            }
        }
    }
}

/// Prints a message and what is missing before it, or why a frame is none.
pub fn print(frame: &Result<Heard, BadFrame>, out: &mut dyn Write) -> io::Result<()> {
    match frame {
        Ok(Heard { received, missed }) => {
            if *missed > 0 {
                writeln!(out, "# {missed} messages missed")?;
            }
            writeln!(out, "{:>5} {}", received.sequence, Words(&received.message))
        }
        Err(bad) => writeln!(out, "# frame skipped: {}", why(*bad)),
    }
}

/// Why a source ended.
#[derive(Debug)]
pub enum End {
    /// There is no more of it.
    Over,
    /// The port went away.
    Unplugged(io::Error),
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_hal_shim::wire::{Answer, FRAME_MAX, Up, encode};

    fn frame(sequence: u16) -> Vec<u8> {
        let mut buffer = [0; FRAME_MAX];
        let message = Up::Answer { of: 7, frame: 0, answer: Answer::Done };
        encode(sequence, &message, &mut buffer).expect("it fits").to_vec()
    }

    #[test]
    fn what_is_missing_is_said_where_it_is_missing() {
        let (mut monitor, mut out) = (Monitor::default(), Vec::new());
        monitor.take(&[frame(65_534), frame(1), frame(2)].concat(), &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert_eq!(
            text,
            "65534 done: command 7\n# 2 messages missed\n    1 done: command 7\n    2 done: command 7\n"
        );
    }
}
