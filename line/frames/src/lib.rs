//! Frames of a fingertip's serial line: [`link`] receives and sends them, [`record`] and [`play`] keep them, [`serve`] gives a board's line
//! to other programs. The boards of `tenax-sim` and the commands of `tenax-line` both use it; [`tool`] is what their command lines share.
#![forbid(unsafe_code)]

pub mod link;
pub mod play;
mod protobuf;
pub mod quantile;
pub mod record;
#[cfg(feature = "host")]
pub mod serve;
pub mod settings;
#[cfg(feature = "host")]
pub mod tool;
pub mod words;
