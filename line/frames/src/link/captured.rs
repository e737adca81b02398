//! The bytes of a line in a file: a recording, or what was captured as it came.

use std::path::Path;

use anyhow::{Context, ensure};
use tenax_hal_shim::wire::{BadFrame, VERSION};

use super::Inbox;
use crate::{mcap, protobuf};

/// The topic of a recording that holds them.
pub const TOPIC: &str = "/line";

/// The bytes of the line in a recording, or in a captured line. Fails if it cannot be read, or holds no message of a board.
pub fn line_of(path: &Path) -> anyhow::Result<Vec<u8>> {
    let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    let line = if is_recording(path) { recorded(path, &bytes)? } else { bytes };
    check(&line, path)?;
    Ok(line)
}

/// Fails if a line from this file holds no message of a board.
pub fn check(line: &[u8], path: &Path) -> anyhow::Result<()> {
    let (mut inbox, mut other) = (Inbox::default(), None);
    for frame in line.iter().filter_map(|&byte| inbox.push(byte)) {
        match frame {
            Ok(_) => return Ok(()),
            Err(BadFrame::Version(version)) => other = Some(version),
            Err(_) => {}
        }
    }
    let name = path.display();
    if let Some(version) = other {
        anyhow::bail!(
            "{name} is of wire version {version}, and this tool reads {VERSION}: use the tool that recorded it"
        );
    }
    anyhow::bail!(
        "{name} is no board's line: none of its {} bytes belongs to a message. `tenax record` writes one",
        line.len()
    )
}

fn recorded(path: &Path, bytes: &[u8]) -> anyhow::Result<Vec<u8>> {
    let (mut line, mut found) = (Vec::new(), false);
    mcap::read(bytes, &mut |topic, _, data| {
        if topic == TOPIC {
            found = true;
            line.extend(protobuf::first_bytes(data).unwrap_or_default());
        }
    })
    .with_context(|| path.display().to_string())?;
    ensure!(found, "{} has no topic {TOPIC}: no board's line was recorded in it", path.display());
    Ok(line)
}

/// Whether a file is called like a recording.
pub fn is_recording(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mcap"))
}
