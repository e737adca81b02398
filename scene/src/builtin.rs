//! The scenes of `scenes/`, carried inside the program, so that `tenax scenes` lists them anywhere.

macro_rules! scenes {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../scenes/", $name, ".toml")))),*]
    };
}

/// Name and text of every scene in the repository, the default one first.
#[must_use]
pub const fn builtin() -> &'static [(&'static str, &'static str)] {
    scenes![
        "glass",
        "glass-quiet",
        "explore-wood",
        "explore-glass",
        "explore-card",
        "knocks",
        "arm-swing",
        "wearer",
        "wearer-control",
        "dead-sensor",
        "pressed-at-boot",
        "pick-up",
        "pick-up-trial",
        "pick-up-reflex",
        "gripper",
        "gripper-control",
        "pour",
        "hold",
        "steel-balls",
        "array-pour",
        "array-pick",
        "array-disturb",
        "array-rotation",
        "array-slow",
        "array-dead",
        "array-stuck",
        "array-lost",
        "array-new-material",
        "array-load",
        "array-noisy",
        "gentle-can",
        "gentle-card",
        "push-gentle",
        "push-hold",
        "hold-marshmallow",
        "hold-toy",
        "hold-crane",
        "hand-over-can",
        "hand-over-card",
        "turn-pen",
        "fill-cup",
        "array-saturated",
        "array-opening",
        "can",
        "rig",
        "head-blocks",
        "head-alone",
    ]
}
