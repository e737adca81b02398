//! The serial line's bytes, written to a file as they come.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

use anyhow::Context;

use crate::board::Recorder;

#[derive(Debug)]
pub struct LineFile {
    path: PathBuf,
    file: io::Result<BufWriter<File>>,
}

impl LineFile {
    pub fn create(path: PathBuf) -> Self {
        Self { file: File::create(&path).map(BufWriter::new), path }
    }

    /// Fails if the bytes could not be written.
    pub fn close(self) -> anyhow::Result<PathBuf> {
        let flushed = self.file.and_then(|mut file| file.flush());
        flushed.with_context(|| format!("cannot write {}", self.path.display()))?;
        Ok(self.path)
    }
}

impl Recorder for LineFile {
    fn line(&mut self, bytes: &[u8]) {
        // After the first error nothing more is written; whoever closes the file is told of it.
        if let Ok(writer) = &mut self.file
            && let Err(error) = writer.write_all(bytes)
        {
            self.file = Err(error);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_written_is_said_when_it_is_closed() {
        let folder = tempfile::tempdir().unwrap();
        let mut line = LineFile::create(folder.path().join("no/such/folder/line.bin"));
        line.line(b"one");
        assert!(format!("{:#}", line.close().unwrap_err()).starts_with("cannot write "));
    }
}
