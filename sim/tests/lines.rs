//! No folder is longer than `budgets.toml` allows.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::Path;

use tenax_sim::budgets::Budgets;

/// Lines of the files with this extension below a folder, but for those that Cargo builds.
fn lines(folder: &Path, extension: &str) -> u64 {
    let files = glob::glob(&format!("{}/**/*.{extension}", folder.display())).expect("a pattern");
    let files = files.map(|path| path.expect("a folder of the checkout"));
    let own = files.filter(|path| {
        let built = |part: &OsStr| part == "target" || part.as_encoded_bytes().starts_with(b".");
        !path.strip_prefix(folder).expect("it is below").iter().any(built)
    });
    own.map(|path| std::fs::read_to_string(path).expect("source is text").lines().count() as u64).sum()
}

#[test]
fn every_folder_is_within_its_lines() {
    let budgets = Budgets::of_checkout().unwrap().lines;
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(&root).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            let script = match name.as_str() {
                "python" => lines(&path, "py"),
                "page" => lines(&path, "js"),
                _ => 0,
            };
            found.insert(name, script + lines(&path, "rs"));
        }
    }
    let over: Vec<_> = found
        .iter()
        .filter(|(name, lines)| **lines > budgets.get(*name).copied().unwrap_or(0))
        .map(|(name, lines)| format!("{name}: {lines} lines, {:?} are allowed", budgets.get(name)))
        .collect();
    assert!(over.is_empty(), "{over:#?}");
}
