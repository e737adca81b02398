//! The serial line's bytes, written to a file as they come.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::Context;

use crate::board::Recorder;

/// A file that is made when the first byte comes.
#[derive(Debug)]
pub struct LineFile {
    path: PathBuf,
    file: Option<io::Result<BufWriter<File>>>,
}

impl LineFile {
    pub fn new(path: PathBuf) -> Self {
        Self { path, file: None }
    }

    /// Where the bytes are, if there were any. Fails if they could not be written.
    pub fn close(self) -> anyhow::Result<Option<PathBuf>> {
        let cannot = |path: &Path| format!("cannot write {}", path.display());
        match self.file {
            None => Ok(None),
            Some(file) => {
                file.and_then(|mut file| file.flush()).with_context(|| cannot(&self.path))?;
                Ok(Some(self.path))
            }
        }
    }
}

impl Recorder for LineFile {
    fn line(&mut self, bytes: &[u8]) {
        if bytes.is_empty() {
            return;
        }
        let file = self.file.get_or_insert_with(|| File::create(&self.path).map(BufWriter::new));
        // After the first error nothing more is written; whoever closes the file is told of it.
        if let Ok(writer) = file
            && let Err(error) = writer.write_all(bytes)
        {
            *file = Err(error);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_in_the_file_and_no_bytes_make_no_file() {
        let folder = tempfile::tempdir().unwrap();
        let mut line = LineFile::new(folder.path().join("line.bin"));
        line.line(b"one ");
        line.line(b"two");
        let path = line.close().unwrap().unwrap();
        assert_eq!(std::fs::read(path).unwrap(), b"one two");
        assert!(LineFile::new(folder.path().join("none.bin")).close().unwrap().is_none());
        assert!(!folder.path().join("none.bin").exists());
    }
}
