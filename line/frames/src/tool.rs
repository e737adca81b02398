//! What the command lines share: output that may be closed, progress, folders, formats, the checkout and its image.

pub mod folder;
pub mod format;
pub mod image;
pub mod out;
pub mod progress;
pub mod stop;
pub mod workspace;

use std::process::ExitCode;

/// Exit code of a command that has ended; prints its error. 2: it could not be run.
pub fn exit(done: anyhow::Result<ExitCode>) -> ExitCode {
    match done {
        Ok(code) => code,
        // The reader of standard output has read enough.
        Err(error) if error.is::<out::Closed>() => ExitCode::SUCCESS,
        Err(error) => {
            out::note!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}
