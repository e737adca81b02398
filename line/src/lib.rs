//! The tools for a Tenax fingertip's serial line: it is watched, recorded, played and set up.
//! One file a command in [`cli`]; the page of `tenax monitor` is [`web`]. `cargo install --locked --path line` installs them alone.
#![forbid(unsafe_code)]

#[cfg(feature = "host")]
pub mod cli;
#[cfg(feature = "host")]
pub mod guide;
pub mod selftest;
pub mod tables;
pub mod view;
#[cfg(feature = "host")]
pub mod web;
