//! What a camera's summaries say, in words for a board.

use std::io::Write;

use tenax_vision::Summary;

/// Writes a teacher's line, `v1 v2 age_ms`, as `tenax monitor --teach` reads it; nothing while the camera has nothing to say.
///
/// # Errors
/// If it cannot be written.
pub fn teach(summary: &Summary, age_ms: u32, out: &mut dyn Write) -> std::io::Result<()> {
    match summary.codes() {
        Some((v1, v2)) => writeln!(out, "{v1} {v2} {age_ms}"),
        None => Ok(()),
    }
}
