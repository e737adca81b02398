//! The hash of what a board decided, for the golden gate.

use std::collections::BTreeMap;
use std::fmt::{self, Write};
use std::fs;
use std::sync::Mutex;

use tenax_sim::board::Run;

static WRITING: Mutex<()> = Mutex::new(());

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden.txt");

/// FNV-1a, 64 bits.
pub struct Hash(u64);

impl Hash {
    pub fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn message(&mut self, message: &impl serde::Serialize) {
        let mut buffer = [0; 2048];
        self.bytes(postcard::to_slice(message, &mut buffer).expect("a message is shorter"));
    }
}

impl fmt::Display for Hash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

pub fn of_run(run: &Run) -> Hash {
    let mut hash = Hash(0xcbf2_9ce4_8422_2325);
    run.slows.iter().for_each(|slow| hash.message(slow));
    run.events.iter().for_each(|event| hash.message(event));
    run.drives.iter().for_each(|drive| hash.message(drive));
    run.feedback.iter().for_each(|feedback| hash.message(feedback));
    hash
}

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
