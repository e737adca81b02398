//! Says whether the recordings are here, and which programs tests ask for: who lacks one has its tests counted as ignored.

use std::process::Command;

include!("../sim/recordings.rs");

fn main() {
    recordings();
    programs();
}

/// Sets `mcap_reader`, with the reader's name in MCAP_PYTHON.
fn programs() {
    println!("cargo::rustc-check-cfg=cfg(mcap_reader)");
    // The public reader of recordings, where `.ci/python` or a person has installed it.
    println!("cargo::rerun-if-env-changed=TENAX_PYTHON");
    if std::path::Path::new("../target/python/pyvenv.cfg").exists() {
        println!("cargo::rerun-if-changed=../target/python/pyvenv.cfg");
    }
    let reads = |name: &String| {
        Command::new(name).args(["-c", "import mcap_protobuf"]).output().is_ok_and(|ran| ran.status.success())
    };
    let own = concat!(env!("CARGO_MANIFEST_DIR"), "/../target/python/bin/python").to_owned();
    if let Some(name) =
        std::env::var("TENAX_PYTHON").into_iter().chain([own, "python3".to_owned()]).find(reads)
    {
        println!("cargo::rustc-cfg=mcap_reader");
        println!("cargo::rustc-env=MCAP_PYTHON={name}");
    }
}
