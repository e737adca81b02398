//! `cargo tenax page`: the page as a folder that any server of files serves.

use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode};

use crate::{cargo, root, status};

const TARGET: &str = "wasm32-unknown-unknown";
const USAGE: &str =
    "cargo tenax page --out FOLDER: writes the page (bench, board, recording) as a folder of static files";

pub fn page(rest: &[std::ffi::OsString]) -> Result<ExitCode, String> {
    let [flag, out] = rest else { return Err(USAGE.to_owned()) };
    if flag != "--out" {
        return Err(USAGE.to_owned());
    }
    // Who sets this builds the target's library from source.
    if std::env::var_os("CARGO_UNSTABLE_BUILD_STD").is_none() && !has_target() {
        eprintln!("rustup fetches the target {TARGET}, once");
        let added = Command::new("rustup").args(["target", "add", TARGET]).current_dir(root()).status();
        if !added.is_ok_and(|status| status.success()) {
            return Err(format!(
                "the target {TARGET} is missing: `rustup target add {TARGET}`, with a network"
            ));
        }
    }
    let mut build = cargo("build", "Cargo.toml");
    let built = status(build.args(["--package", "tenax-page", "--profile", "page", "--target", TARGET]))?;
    if built != ExitCode::SUCCESS {
        return Ok(built);
    }
    let machine = root().join("target").join(TARGET).join("page/tenax_page.wasm");
    let out = Path::new(out);
    write(&machine, out).map_err(|error| format!("cannot write {}: {error}", out.display()))?;
    println!(
        "{}: serve it with any server of files, such as `python3 -m http.server --directory {0}`",
        out.display()
    );
    Ok(ExitCode::SUCCESS)
}

/// Whether the compiler that builds the workspace has the target's library.
fn has_target() -> bool {
    let asked = ["--print", "target-libdir", "--target", TARGET];
    let Ok(told) = Command::new("rustc").args(asked).current_dir(root()).output() else { return false };
    told.status.success() && Path::new(String::from_utf8_lossy(&told.stdout).trim()).exists()
}

fn write(machine: &Path, out: &Path) -> std::io::Result<()> {
    fs::create_dir_all(out)?;
    for file in fs::read_dir(root().join("page/www"))? {
        let file = file?;
        fs::copy(file.path(), out.join(file.file_name()))?;
    }
    fs::copy(machine, out.join("tenax.wasm"))?;
    Ok(())
}
