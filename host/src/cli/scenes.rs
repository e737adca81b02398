//! `tenax scenes`: what there is to run.

use std::process::ExitCode;

use tenax_scene::{SceneFile, builtin};

use super::out;

pub fn main() -> anyhow::Result<ExitCode> {
    for (name, text) in builtin() {
        let scene = SceneFile::parse(text, &format!("scenes/{name}.toml"))?;
        out::say!(
            "{name:<20} {:>4.0} s  {}\n{:<28} from {}",
            scene.duration_s(),
            scene.title,
            "",
            scene.from
        )?;
    }
    Ok(ExitCode::SUCCESS)
}
