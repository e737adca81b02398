//! Whether a program is what Cargo would build again, found out without Cargo: it waits for whatever build holds its lock.
//!
//! Cargo itself leaves the list of a program's sources beside it (`NAME.d`), build scripts' among them. A stamp (`NAME.built`)
//! says how the program was built and which file that gave; its own time is when that build began. As Cargo does, a source is
//! taken for unchanged if it is older.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::{Context, Result};

/// What is built from more than sources: read by Cargo in every folder from a source up to the workspace.
const SETTINGS: [&str; 4] = ["Cargo.toml", "Cargo.lock", ".cargo/config.toml", "rust-toolchain.toml"];
/// What a person may set for a build.
const VARIABLES: [&str; 3] = ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "RUSTUP_TOOLCHAIN"];

/// A program that is built from a workspace.
pub struct Program<'a> {
    /// The workspace.
    pub root: &'a Path,
    pub file: PathBuf,
    /// What Cargo is told.
    pub how: String,
}

impl Program<'_> {
    /// Whether a build would give the same.
    pub fn is_fresh(&self) -> bool {
        let fresh = || {
            let stamp = self.file.with_extension("built");
            let since = fs::metadata(&stamp).ok()?.modified().ok()?;
            let same = fs::read_to_string(&stamp).ok()? == self.told()?;
            let older = |path: &PathBuf| {
                fs::metadata(path).and_then(|file| file.modified()).is_ok_and(|changed| changed < since)
            };
            Some(same && self.sources()?.iter().all(older))
        };
        fresh().unwrap_or(false)
    }

    /// Notes that a build that began then has succeeded. Fails if the note cannot be written.
    pub fn built(&self, begun: SystemTime) -> Result<()> {
        let stamp = self.file.with_extension("built");
        let write = || {
            // First, so that a stamp that is half written is never believed.
            let told = self.told().unwrap_or_default();
            fs::write(&stamp, told)?;
            File::options().write(true).open(&stamp)?.set_modified(begun)
        };
        write().with_context(|| format!("cannot write {}", stamp.display()))
    }

    /// How it was built, and which file it is: somebody may have built another in its place.
    fn told(&self) -> Option<String> {
        let file = fs::metadata(&self.file).ok()?;
        let changed_ns = file.modified().ok()?.duration_since(UNIX_EPOCH).ok()?.as_nanos();
        let set = VARIABLES.map(|name| std::env::var(name).unwrap_or_default()).join("\n");
        Some(format!("{}\n{}\n{set}\n{} bytes, {changed_ns} ns\n", self.root.display(), self.how, file.len()))
    }

    /// Every file that it is made from.
    fn sources(&self) -> Option<BTreeSet<PathBuf>> {
        let list = fs::read_to_string(self.file.with_extension("d")).ok()?;
        let (_, list) = list.lines().next()?.split_once(": ")?;
        // A space in a path is written with a backslash before it.
        let list = list.replace("\\ ", "\0");
        let mut all: BTreeSet<PathBuf> =
            list.split_whitespace().map(|path| PathBuf::from(path.replace('\0', " "))).collect();
        let folders: BTreeSet<&Path> = all
            .iter()
            .flat_map(|path| path.ancestors().skip(1).take_while(|folder| folder.starts_with(self.root)))
            .chain([self.root])
            .collect();
        let settings = folders.iter().flat_map(|folder| SETTINGS.map(|name| folder.join(name)));
        let settings: Vec<_> = settings.filter(|path| path.exists()).collect();
        all.extend(settings);
        Some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn whatever_a_build_would_look_at_makes_it_stale() {
        let root = std::env::temp_dir().join(format!("tenax-fresh-{}", std::process::id()));
        let [source, program] = [root.join("a b/src/main.rs"), root.join("program")];
        fs::create_dir_all(source.parent().unwrap()).unwrap();
        let list = format!("{}: {}\n", program.display(), source.to_string_lossy().replace(' ', "\\ "));
        fs::write(root.join("program.d"), list).unwrap();
        let settings = [root.join("Cargo.lock"), root.join("a b/Cargo.toml")];
        let inputs = [&source, &settings[0], &settings[1]];
        let begun = SystemTime::now();
        let age = |path: &Path, time: SystemTime| {
            File::options().write(true).open(path).unwrap().set_modified(time).unwrap();
        };
        let old = || {
            for input in inputs {
                fs::write(input, "x").unwrap();
                age(input, begun - Duration::from_secs(9));
            }
            fs::write(&program, "built").unwrap();
        };
        let of = |how: &str| Program { root: &root, file: program.clone(), how: how.to_owned() };
        old();
        assert!(!of("a").is_fresh(), "nobody has built it");
        of("a").built(begun).unwrap();
        assert!(of("a").is_fresh());
        assert!(!of("b").is_fresh(), "built in another way");
        for input in inputs {
            age(input, begun + Duration::from_secs(1));
            assert!(!of("a").is_fresh(), "changed while it was built, or later: {}", input.display());
            age(input, begun - Duration::from_secs(9));
            assert!(of("a").is_fresh());
        }
        fs::remove_file(&source).unwrap();
        assert!(!of("a").is_fresh(), "a source is gone");
        old();
        fs::write(&program, "by somebody else").unwrap();
        assert!(!of("a").is_fresh(), "another program in its place");
        fs::remove_dir_all(&root).unwrap();
    }
}
