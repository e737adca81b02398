//! The bytes of a line in a file: a recording (MCAP), or the bytes alone.

use std::path::Path;

use anyhow::{Context, bail, ensure};
use mcap::MessageStream;
use mcap::read::Options;
use tenax_hal_shim::wire::{BadFrame, VERSION};

use super::Inbox;
use crate::protobuf;

pub const TOPIC: &str = "/line";

/// The line's bytes in a recording or a captured line. Of a recording that was cut short, its whole chunks.
/// Fails if the file cannot be read, or holds no message of a board.
pub fn line_of(path: &Path) -> anyhow::Result<Vec<u8>> {
    let name = path.display();
    let bytes = std::fs::read(path).with_context(|| format!("cannot read {name}"))?;
    let line = if is_recording(path) { recorded(path, &bytes)? } else { bytes };
    let (mut inbox, mut other) = (Inbox::default(), None);
    for frame in line.iter().filter_map(|&byte| inbox.push(byte)) {
        match frame {
            Ok(_) => return Ok(line),
            Err(BadFrame::Version(version)) => other = Some(version),
            Err(_) => {}
        }
    }
    match other {
        Some(version) => bail!("{name} is of wire version {version}, and this tool reads {VERSION}"),
        None => bail!(
            "{name} is no board's line: none of its {} bytes belongs to a message. `tenax record` writes one",
            line.len()
        ),
    }
}

fn recorded(path: &Path, bytes: &[u8]) -> anyhow::Result<Vec<u8>> {
    let name = path.display();
    ensure!(bytes.starts_with(mcap::MAGIC), "{name}: this is no MCAP file");
    let messages = MessageStream::new_with_options(bytes, Options::IgnoreEndMagic.into())?;
    let (mut line, mut found) = (Vec::new(), false);
    for message in messages.map_while(Result::ok).filter(|message| message.channel.topic == TOPIC) {
        found = true;
        line.extend(protobuf::first_bytes(&message.data).unwrap_or_default());
    }
    ensure!(found, "{name} has no topic {TOPIC}: no board's line was recorded in it");
    Ok(line)
}

pub fn is_recording(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mcap"))
}
