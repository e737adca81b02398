//! The bytes of a line in a file: a recording, or what was captured as it came.

use std::path::Path;

use anyhow::Context;

use crate::{mcap, protobuf};

/// The topic of a recording that holds them.
pub const TOPIC: &str = "/line";

/// The bytes of the line in a recording, or in a captured line. Fails if it cannot be read.
pub fn line_of(path: &Path) -> anyhow::Result<Vec<u8>> {
    let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    if !is_recording(path) {
        return Ok(bytes);
    }
    let (mut line, mut found) = (Vec::new(), false);
    mcap::read(&bytes, &mut |topic, _, data| {
        if topic == TOPIC {
            found = true;
            line.extend(protobuf::first_bytes(data).unwrap_or_default());
        }
    })
    .with_context(|| path.display().to_string())?;
    anyhow::ensure!(found, "{} has no topic {TOPIC}: no board's line was recorded in it", path.display());
    Ok(line)
}

/// Whether a file is called like a recording.
pub fn is_recording(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mcap"))
}
