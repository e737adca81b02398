//! The bytes of a line in a file: a recording (MCAP), or the bytes alone.

use std::path::Path;

#[cfg(feature = "host")]
use anyhow::Context;
use anyhow::{bail, ensure};
use mcap::read::Options;
use mcap::{McapError, MessageStream};
use tenax_hal_shim::wire::{BadFrame, VERSION};

use super::{Heard, Inbox};
use crate::protobuf;

pub const TOPIC: &str = "/line";

/// The bytes of a line in a file.
pub struct Captured {
    pub line: Vec<u8>,
    /// Ends of the pieces in which they were recorded, and when each came, ns since 1970. None where only the bytes were kept.
    came: Vec<(usize, u64)>,
}

/// The bytes of the line in a file: see [`Captured::open`].
#[cfg(feature = "host")]
pub fn line_of(path: &Path) -> anyhow::Result<Vec<u8>> {
    Ok(Captured::open(path)?.line)
}

impl Captured {
    #[cfg(feature = "host")]
    /// A recording or a captured line. Of a recording that was cut short, its whole chunks; says so.
    /// Fails if the file cannot be read, or holds no message of a board.
    pub fn open(path: &Path) -> anyhow::Result<Self> {
        let name = path.display();
        let bytes = std::fs::read(path).with_context(|| format!("cannot read {name}"))?;
        let (captured, is_whole) = Self::of(&name.to_string(), bytes)?;
        if !is_whole {
            crate::tool::out::note!(
                "{name}: its end is missing, as of a recorder that was killed; what is whole is read"
            );
        }
        Ok(captured)
    }

    /// As [`open`](Self::open), of a file's name and bytes. False: the recording's end is missing.
    pub fn of(name: &str, bytes: Vec<u8>) -> anyhow::Result<(Self, bool)> {
        let (captured, is_whole) = match is_recording(Path::new(name)) {
            true => recorded(name, &bytes)?,
            false => (Self { line: bytes, came: Vec::new() }, true),
        };
        let mut other = None;
        let is_line = captured.frames().any(|(_, _, frame)| {
            if let Err(BadFrame::Version(version)) = frame {
                other = Some(version);
            }
            frame.is_ok()
        });
        match other {
            _ if is_line => Ok((captured, is_whole)),
            Some(version) => bail!("{name} is of wire version {version}, and this tool reads {VERSION}"),
            None => bail!(
                "{name} is no board's line: none of its {} bytes belongs to a message. `tenax record` writes one",
                captured.line.len()
            ),
        }
    }

    /// Every frame: its end (bytes), when it came (ns since 1970), and its message.
    pub fn frames(&self) -> impl Iterator<Item = (usize, Option<u64>, Result<Heard, BadFrame>)> {
        let (mut inbox, mut pieces) = (Inbox::default(), self.came.iter().peekable());
        self.line.iter().enumerate().filter_map(move |(n, &byte)| {
            let frame = inbox.push(byte)?;
            while pieces.next_if(|(end, _)| *end <= n).is_some() {}
            Some((n + 1, pieces.peek().map(|(_, came_ns)| *came_ns), frame))
        })
    }
}

fn recorded(name: &str, bytes: &[u8]) -> anyhow::Result<(Captured, bool)> {
    ensure!(bytes.starts_with(mcap::MAGIC), "{name}: this is no MCAP file");
    let messages = MessageStream::new_with_options(bytes, Options::IgnoreEndMagic.into())?;
    let (mut captured, mut is_whole) =
        (Captured { line: Vec::new(), came: Vec::new() }, bytes.ends_with(mcap::MAGIC));
    for message in messages {
        match message {
            Ok(message) if message.channel.topic == TOPIC => {
                captured.line.extend(protobuf::first_bytes(&message.data).unwrap_or_default());
                captured.came.push((captured.line.len(), message.publish_time));
            }
            Ok(_) => {}
            Err(McapError::UnsupportedCompression(with)) => bail!(
                "{name} is compressed with {with}, which this tool does not read: `mcap decompress {name} --output FILE.mcap` \
                 makes one that it reads"
            ),
            Err(_) => {
                is_whole = false;
                break;
            }
        }
    }
    ensure!(!captured.came.is_empty(), "{name} has no topic {TOPIC}: no board's line was recorded in it");
    Ok((captured, is_whole))
}

pub fn is_recording(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mcap"))
}
