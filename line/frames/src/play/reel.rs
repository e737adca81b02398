//! A recording in pieces, each with its time, that are read one by one: an hour begins anywhere at once.

use std::fs::File;
use std::path::Path;

use anyhow::Context;
use tenax_hal_shim::wire::Up;

use crate::link::captured::{self, TOPIC, is_recording};
use crate::link::{Heard, Inbox};
use crate::mcap::{self, Chunk, Topics};
use crate::protobuf;
use crate::words::seconds;

/// How long a piece of a captured line is, s.
const PIECE_S: f64 = 0.5;

/// A recording.
pub struct Reel {
    kind: Kind,
    length_s: f64,
}

enum Kind {
    Recording {
        file: File,
        chunks: Vec<Chunk>,
        topics: Topics,
    },
    /// Messages of a captured line, and where each piece begins, s.
    Captured {
        pieces: Vec<Vec<(f64, Heard)>>,
    },
}

impl Reel {
    /// One in a file. Fails if it cannot be read, or holds no message of a board.
    pub fn open(path: &Path) -> anyhow::Result<Self> {
        if !is_recording(path) {
            return Ok(Self::captured(&captured::line_of(path)?));
        }
        let name = || path.display().to_string();
        let mut file = File::open(path).with_context(|| format!("cannot read {}", path.display()))?;
        let chunks = mcap::chunks(&mut file).with_context(name)?;
        let [Some(first), Some(last)] = [chunks.first(), chunks.last()] else {
            // One that nobody packed is read whole, or refused with the reason.
            return Ok(Self::captured(&captured::line_of(path)?));
        };
        let length_s = since(first, last.last_ns);
        let mut line = Vec::new();
        let mut topics = Topics::new();
        let mut take = |topic: &str, _, data: &[u8]| {
            if topic == TOPIC {
                line.extend(protobuf::first_bytes(data).unwrap_or_default());
            }
        };
        mcap::chunk(&mut file, first, &mut topics, &mut take).with_context(name)?;
        captured::check(&line, path)?;
        Ok(Self { kind: Kind::Recording { file, chunks, topics }, length_s })
    }

    fn captured(line: &[u8]) -> Self {
        let (mut inbox, mut pieces) = (Inbox::default(), vec![Vec::new()]);
        // A board that starts anew counts from 0 again: its time goes on where it was.
        let (mut at_s, mut zero_s, mut begun_s) = (0.0, None, 0.0);
        for heard in line.iter().filter_map(|&byte| inbox.push(byte)).flatten() {
            match &heard.received.message {
                Up::Hello { .. } => zero_s = Some(at_s),
                Up::Slow(slow) => {
                    let board_s = seconds(slow.frame);
                    at_s = board_s + *zero_s.get_or_insert(-board_s);
                }
                _ => {}
            }
            if at_s - begun_s >= PIECE_S {
                begun_s = at_s;
                pieces.push(Vec::new());
            }
            if let Some(piece) = pieces.last_mut() {
                piece.push((at_s, heard));
            }
        }
        Self { kind: Kind::Captured { pieces }, length_s: at_s }
    }

    pub const fn length_s(&self) -> f64 {
        self.length_s
    }

    /// The piece that holds this instant.
    pub fn piece_at(&self, at_s: f64) -> usize {
        let after = match &self.kind {
            Kind::Recording { chunks, .. } => {
                chunks.partition_point(|chunk| since(&chunks[0], chunk.first_ns) <= at_s)
            }
            Kind::Captured { pieces } => {
                pieces.partition_point(|piece| piece.first().is_none_or(|(first_s, _)| *first_s <= at_s))
            }
        };
        after.saturating_sub(1)
    }

    /// What was said in a piece, each with its time, s; None: there are no more. Fails if the file cannot be read.
    pub fn piece(&mut self, n: usize) -> anyhow::Result<Option<Vec<(f64, Heard)>>> {
        let (file, chunks, topics) = match &mut self.kind {
            Kind::Captured { pieces } => return Ok(pieces.get(n).cloned()),
            Kind::Recording { file, chunks, topics } => (file, chunks, topics),
        };
        let Some(chunk) = chunks.get(n) else { return Ok(None) };
        let (mut inbox, mut said) = (Inbox::default(), Vec::new());
        let mut take = |topic: &str, at_ns, data: &[u8]| {
            if topic == TOPIC {
                let bytes = protobuf::first_bytes(data).unwrap_or_default();
                let heard = bytes.iter().filter_map(|&byte| inbox.push(byte)).flatten();
                said.extend(heard.map(|heard| (since(&chunks[0], at_ns), heard)));
            }
        };
        mcap::chunk(file, chunk, topics, &mut take)?;
        Ok(Some(said))
    }
}

fn since(first: &Chunk, at_ns: u64) -> f64 {
    at_ns.saturating_sub(first.first_ns) as f64 / 1e9
}
