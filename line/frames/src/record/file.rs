//! A recording in a file, by this computer's clock.

use std::fs::File;
use std::io::{BufWriter, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use anyhow::{Context, bail};
use mcap::McapResult;
use tenax_hal_shim::wire::{Received, Up};

use super::Tape;
use crate::link::Inbox;
use crate::link::captured::is_recording;

/// The name of a recording that begins now: `tenax-20261123T081500Z.mcap`.
pub fn name_now() -> PathBuf {
    let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    PathBuf::from(format!("tenax-{}.mcap", now.replace(['-', ':'], "")))
}

/// Messages reach the file after so much of the recording computer's time, or of the board's.
const WHOLE_EVERY: Duration = Duration::from_millis(500);

pub struct Recording {
    path: PathBuf,
    tape: Tape<BufWriter<File>>,
    /// When the file was begun, ns since 1970, and by a clock that nobody sets.
    began_ns: u64,
    began: Instant,
    /// When the oldest message that is not in the file came, and its log time, ns.
    oldest: Option<(Instant, u64)>,
    inbox: Inbox,
}

impl Recording {
    /// A recording in a new file. Fails if the file cannot be written, is there already, or is not called `*.mcap`.
    pub fn create(path: &Path) -> anyhow::Result<Self> {
        let name = path.display();
        if !is_recording(path) {
            bail!(
                "{name}: a recording is an MCAP file; call it {}. `tenax play FILE.mcap --csv DIR` makes CSV of it",
                path.with_extension("mcap").display()
            );
        }
        let file = match File::create_new(path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                bail!("{name} is there already, and a recording overwrites nothing: choose another name")
            }
            other => other.with_context(|| format!("cannot write {name}"))?,
        };
        let began_ns =
            SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as u64);
        Ok(Self {
            path: path.to_owned(),
            tape: Tape::new(BufWriter::new(file), began_ns)?,
            began_ns,
            began: Instant::now(),
            oldest: None,
            inbox: Inbox::default(),
        })
    }

    /// Records a message. Fails if the file cannot be written: it is whole up to there.
    pub fn take(&mut self, received: &Received<Up>) -> anyhow::Result<()> {
        self.try_take(received).with_context(|| self.cannot())
    }

    fn try_take(&mut self, received: &Received<Up>) -> McapResult<()> {
        let came_ns = self.began_ns + self.began.elapsed().as_nanos() as u64;
        let Some(log_ns) = self.tape.take(received, came_ns)? else { return Ok(()) };
        let (_, from_ns) = *self.oldest.get_or_insert((Instant::now(), log_ns));
        if log_ns.saturating_sub(from_ns) >= WHOLE_EVERY.as_nanos() as u64 {
            self.flush()?;
        }
        Ok(())
    }

    /// Writes what has waited for long enough; to be called all the time. Fails as [`take`](Self::take) does.
    pub fn keep(&mut self) -> anyhow::Result<()> {
        match self.oldest {
            Some((came, _)) if came.elapsed() >= WHOLE_EVERY => self.flush().with_context(|| self.cannot()),
            _ => Ok(()),
        }
    }

    fn flush(&mut self) -> McapResult<()> {
        self.oldest = None;
        self.tape.flush()
    }

    fn cannot(&self) -> String {
        format!("cannot write {}, which is whole up to there", self.path.display())
    }

    /// Records the messages in a line's bytes. Fails as [`take`](Self::take) does.
    pub fn line(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        for &byte in bytes {
            if let Some(Ok(heard)) = self.inbox.push(byte) {
                self.take(&heard.received)?;
            }
        }
        self.keep()
    }

    /// Ends the file. Fails if it could not be written whole.
    pub fn finish(self) -> anyhow::Result<()> {
        let cannot = self.cannot();
        self.tape.finish().map(drop).context(cannot)
    }
}
