//! Both directions of a line: commands are sent, their answers waited for, and every message counted.

use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use tenax_hal_shim::wire::{Answer, Down, Refusal, Up};

use super::{Counts, Heard, Inbox, Line, Outbox, Target};

/// A client of a board.
pub struct Client {
    up: Box<dyn Read + Send>,
    outbox: Option<Outbox<Box<dyn Write + Send>>>,
    inbox: Inbox,
    heard: VecDeque<Heard>,
}

impl From<Line> for Client {
    fn from(line: Line) -> Self {
        Self {
            up: line.up,
            outbox: line.down.map(Outbox::new),
            inbox: Inbox::default(),
            heard: VecDeque::new(),
        }
    }
}

impl Client {
    /// One on the line at `target`.
    ///
    /// # Errors
    /// As [`Target::open`].
    pub fn open(target: &Target) -> anyhow::Result<Self> {
        target.open().map(Self::from)
    }

    /// What has been counted.
    #[must_use]
    pub fn counts(&self) -> Counts {
        self.inbox.counts()
    }

    /// The next message. None while there is none yet, after a tenth of a second at most.
    ///
    /// # Errors
    /// If the line has ended: `UnexpectedEof` where it was closed in order.
    pub fn next_message(&mut self) -> io::Result<Option<Heard>> {
        if self.heard.is_empty() {
            self.read()?;
        }
        Ok(self.heard.pop_front())
    }

    /// Sends a command and returns its answer. The messages before it are skipped, but counted. What changes something
    /// needs a session: one is opened when the board asks for it.
    ///
    /// # Errors
    /// If there is no answer in `within`, or the line has ended, or is a captured one.
    pub fn ask(&mut self, command: &Down, within: Duration) -> anyhow::Result<Answer> {
        let answer = self.ask_once(command, within)?;
        if !matches!(answer, Answer::Refused(Refusal::NoSession | Refusal::Replayed)) {
            return Ok(answer);
        }
        // Somebody else on the same line may have opened one of their own: then the numbers that count are theirs.
        let Answer::Nonce(nonce) = self.ask_once(&Down::Hello, within)? else {
            return Ok(answer);
        };
        self.ask_once(&Down::Open { nonce }, within)?;
        self.ask_once(command, within)
    }

    fn ask_once(&mut self, command: &Down, within: Duration) -> anyhow::Result<Answer> {
        let Some(outbox) = &mut self.outbox else {
            bail!("a captured line cannot be told anything: give a port, or tcp:HOST:PORT");
        };
        let number = outbox.send(command).context("cannot write to the line")?;
        let began = Instant::now();
        while began.elapsed() < within {
            let heard = self.next_message().context("the line ended before the answer came")?;
            match heard.map(|heard| heard.received.message) {
                Some(Up::Answer { of, answer, .. }) if of == number => return Ok(answer),
                _ => {}
            }
        }
        bail!("no answer in {} s: is this a fingertip's line?", within.as_secs_f64())
    }

    fn read(&mut self) -> io::Result<()> {
        let mut buffer = [0; 4096];
        match self.up.read(&mut buffer) {
            Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
            Ok(length) => {
                let heard = buffer[..length].iter().filter_map(|&byte| self.inbox.push(byte));
                self.heard.extend(heard.flatten());
                Ok(())
            }
            Err(error) if is_silence(&error) => Ok(()),
            Err(error) => Err(error),
        }
    }
}

/// Whether a read failed only because nothing has come yet.
pub fn is_silence(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted)
}
