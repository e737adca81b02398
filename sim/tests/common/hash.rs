//! Compares the hashes of what boards decided with the golden ones.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::sync::Mutex;

use tenax_sim::board::hash::Hash;

static WRITING: Mutex<()> = Mutex::new(());

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden.txt");

/// Compares what was hashed with the lines of `golden.txt` whose first word is `kind`.
pub fn compare(kind: &str, hashes: &BTreeMap<String, Hash>) {
    let _writing = WRITING.lock().expect("no test failed while it wrote");
    let held = fs::read_to_string(FILE).unwrap_or_default();
    let mut lines = String::new();
    for (name, hash) in hashes {
        writeln!(lines, "{kind} {name} {hash}").expect("a string has room");
    }
    if std::env::var("TENAX_GOLDEN").is_ok_and(|asked| asked == "write") {
        let others = held.lines().filter(|line| !line.starts_with(&format!("{kind} ")));
        let mut all: Vec<&str> = others.chain(lines.lines()).collect();
        all.sort_unstable();
        fs::write(FILE, all.join("\n") + "\n").expect("the file can be written");
        return;
    }
    let held: Vec<&str> = held.lines().filter(|line| line.starts_with(&format!("{kind} "))).collect();
    let differ: Vec<&str> = lines.lines().filter(|line| !held.contains(line)).collect();
    assert!(differ.is_empty(), "another decision, event or force in\n{}", differ.join("\n"));
    assert_eq!(held.len(), hashes.len(), "golden.txt names other {kind}s than there are");
}
