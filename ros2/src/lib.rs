//! A fingertip's messages as ROS 2 has them, by rmw_zenoh's rules (its docs/design.md): [`message`]s with their types' hashes,
//! written as CDR ([`cdr`]) under [`key`]s, and what of a board's line becomes which ([`hand`]).
//! No network: that is the bridge's, which takes 200 packages more.
#![forbid(unsafe_code)]

pub mod cdr;
pub mod hand;
pub mod key;
pub mod message;

#[cfg(feature = "bridge")]
pub mod bridge;
