//! Recordings of a board's line: MCAP for Foxglove, PlotJuggler and Python, and CSV with the same values.
//!
//! The topic `/line` holds the bytes as they came; all other topics are made from them. So a recording is played, watched
//! and replayed like a captured line, and what a later tool knows better it takes from the bytes again.

pub mod csv;
pub mod topics;

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::Context;
use tenax_hal_shim::wire::{FRAME_MAX, Received, Up, encode};

use self::topics::{Topic, rows, seconds};
use crate::link::Inbox;
use crate::mcap::Writer;
use crate::protobuf::{self, PACKAGE, Value};

/// A recording that is being written.
pub struct Recording {
    file: Writer<BufWriter<File>>,
    channels: Vec<(Topic, u16)>,
    began_ns: u64,
    last: u32,
    error: Option<io::Error>,
    inbox: Inbox,
}

impl Recording {
    /// A recording in a new file. The board's time 0 is now. Fails if the file cannot be written.
    pub fn create(path: &Path) -> anyhow::Result<Self> {
        let cannot = || format!("cannot write {}", path.display());
        let out = BufWriter::new(File::create(path).with_context(cannot)?);
        let mut file = Writer::new(out).with_context(cannot)?;
        let channels = Topic::all()
            .into_iter()
            .map(|topic| {
                let message = topic.message();
                let descriptor = protobuf::descriptor(message, &topic.fields());
                (topic, file.channel(&topic.name(), &format!("{PACKAGE}.{message}"), &descriptor))
            })
            .collect();
        let began_ns =
            SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as u64);
        Ok(Self { file, channels, began_ns, last: 0, error: None, inbox: Inbox::default() })
    }

    /// Takes a message in. An error is kept for [`finish`](Self::finish).
    pub fn take(&mut self, received: &Received<Up>) {
        let rows = rows(&received.message, self.last);
        if let Some(last) = rows.iter().map(|(_, frame, _)| *frame).max() {
            self.last = self.last.max(last);
        }
        let mut buffer = [0; FRAME_MAX];
        let bytes = encode(received.sequence, &received.message, &mut buffer).map(|bytes| bytes.to_vec());
        let line = bytes.map(|bytes| (Topic::Line, self.last, vec![Value::Bytes(bytes)]));
        for (topic, frame, values) in line.into_iter().chain(rows) {
            let at_ns = self.began_ns + (seconds(frame) * 1e9) as u64;
            let channel = self.channels.iter().find(|(own, _)| *own == topic).map_or(0, |(_, id)| *id);
            if let Err(error) = self.file.message(channel, at_ns, &protobuf::message(&values)) {
                self.error.get_or_insert(error);
            }
        }
    }

    /// Takes in what comes up a line, as it comes.
    pub fn line(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            if let Some(Ok(heard)) = self.inbox.push(byte) {
                self.take(&heard.received);
            }
        }
    }

    /// Ends the file. Fails if it could not be written whole.
    pub fn finish(self) -> io::Result<()> {
        let finished = self.file.finish().map(drop);
        self.error.map_or(finished, Err)
    }
}
