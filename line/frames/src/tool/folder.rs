//! The folder that results go to, made and tried before any work begins.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};

/// The folder, made if it is not there. Fails if it cannot be made, is no folder, or cannot be written to.
pub fn made(folder: &Path) -> anyhow::Result<PathBuf> {
    let cannot = || format!("cannot write to the folder {}", folder.display());
    if folder.exists() && !folder.is_dir() {
        bail!("{}: is a file, and a folder is needed", cannot());
    }
    fs::create_dir_all(folder).with_context(cannot)?;
    // A folder of somebody else's is noticed now, not after an hour.
    let trial = folder.join(format!(".tenax-{}", std::process::id()));
    fs::write(&trial, []).and_then(|()| fs::remove_file(&trial)).with_context(cannot)?;
    Ok(folder.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_made_and_left_empty_and_a_file_is_none() {
        let folder = tempfile::tempdir().unwrap();
        let inner = made(&folder.path().join("a/b")).unwrap();
        assert_eq!(fs::read_dir(inner).unwrap().count(), 0);
        let file = tempfile::NamedTempFile::new().unwrap();
        let error = format!("{:#}", made(file.path()).unwrap_err());
        assert!(error.contains("is a file, and a folder is needed"), "{error}");
    }
}
