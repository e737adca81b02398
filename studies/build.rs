//! Says whether the recordings are here, and QEMU's Cortex-M.

include!("../recordings.rs");

fn main() {
    recordings();
    println!("cargo::rustc-check-cfg=cfg(qemu)");
    if std::process::Command::new("qemu-system-arm").arg("--version").output().is_ok() {
        println!("cargo::rustc-cfg=qemu");
    }
}
