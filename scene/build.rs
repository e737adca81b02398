//! Lists `scenes/` and `scenes/parts/`, so that one more scene is one more file, and says whether the recordings are here.

use std::fmt::Write;
use std::path::Path;
use std::{env, fs};

include!("../sim/recordings.rs");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    recordings();
    let mut text = String::new();
    for (constant, folder) in [("SCENES", "../scenes"), ("PARTS", "../scenes/parts")] {
        println!("cargo::rerun-if-changed={folder}");
        let mut names: Vec<String> = fs::read_dir(folder)?
            .filter_map(|entry| entry.ok()?.file_name().to_str()?.strip_suffix(".toml").map(str::to_owned))
            .collect();
        // The one that runs when nobody says which comes first.
        names.sort_by_key(|name| (name != "glass", name.clone()));
        writeln!(text, "const {constant}: &[(&str, &str)] = &[")?;
        for name in names {
            let file = format!("/{folder}/{name}.toml");
            writeln!(text, "    ({name:?}, include_str!(concat!(env!(\"CARGO_MANIFEST_DIR\"), {file:?}))),")?;
        }
        writeln!(text, "];")?;
    }
    fs::write(Path::new(&env::var("OUT_DIR")?).join("scenes.rs"), text)?;
    Ok(())
}
