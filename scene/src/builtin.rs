//! The scenes of `scenes/`, carried inside the program, so that `tenax run --list` lists them anywhere.

use std::borrow::Cow;

// `SCENES` and `PARTS`, listed by `build.rs`.
include!(concat!(env!("OUT_DIR"), "/scenes.rs"));

pub const fn builtin() -> &'static [(&'static str, &'static str)] {
    SCENES
}

pub const fn parts() -> &'static [(&'static str, &'static str)] {
    PARTS
}

pub fn find(name: &str) -> Option<(String, Cow<'static, str>)> {
    let among = |all: &[(&str, &'static str)], folder| {
        let (_, text) = all.iter().find(|(known, _)| *known == name)?;
        Some((format!("{folder}/{name}.toml"), Cow::Borrowed(*text)))
    };
    among(SCENES, "scenes").or_else(|| among(PARTS, "scenes/parts"))
}
