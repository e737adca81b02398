//! Tells the linker where the memory map is and which scripts place the image in it.

use std::path::Path;

fn main() {
    let manifest = std::env::var("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR");
    // memory.x stands at the workspace's root: it is the chip's, not this package's.
    let root = Path::new(&manifest).parent().expect("the package is in the workspace");
    println!("cargo::rustc-link-search={}", root.display());
    println!("cargo::rerun-if-changed={}", root.join("memory.x").display());
    println!("cargo::rerun-if-changed=build.rs");
    let log = std::env::var_os("CARGO_FEATURE_LOG").map(|_| "-Tdefmt.x");
    for argument in ["--nmagic", "--build-id=sha1", "-Tlink.x"].into_iter().chain(log) {
        println!("cargo::rustc-link-arg-bins={argument}");
    }
}
