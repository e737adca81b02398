//! The scenes of `scenes/`, carried inside the program, so that `tenax scenes` lists them anywhere.

use std::borrow::Cow;

// `SCENES` and `PARTS`, listed by `build.rs`.
include!(concat!(env!("OUT_DIR"), "/scenes.rs"));

/// Name and text of every scene in the repository, the default one first.
pub const fn builtin() -> &'static [(&'static str, &'static str)] {
    SCENES
}

/// Name and text of what scenes share and is none by itself: `scenes/parts/`.
pub const fn parts() -> &'static [(&'static str, &'static str)] {
    PARTS
}

/// File and text of the scene or part that is called so.
pub fn find(name: &str) -> Option<(String, Cow<'static, str>)> {
    let among = |all: &[(&str, &'static str)], folder| {
        let (_, text) = all.iter().find(|(known, _)| *known == name)?;
        Some((format!("{folder}/{name}.toml"), Cow::Borrowed(*text)))
    };
    among(SCENES, "scenes").or_else(|| among(PARTS, "scenes/parts"))
}
