//! The serial tools of a Tenax fingertip: what comes up a board's line and goes down it, watched, recorded, played, set up.
//!
//! Here lives what a person needs beside a real board, and what is installed alone: `cargo install --path serial`.
//! It takes the wire's messages from `tenax-hal-shim`, and of `tenax-logic` the rows of the settings; it decides nothing.
//! No emulator, no scenes, no plots, no report: those are the bench's, which is built on this.
//! A command that the whole tool has, too, is defined here once, in [`cli`].
//! What is built here is paid for by whoever waits for `tenax monitor`: 90 s from nothing, on two cores.
#![forbid(unsafe_code)]

pub mod cli;
pub mod guide;
pub mod link;
pub mod mcap;
pub mod monitor;
pub mod play;
pub mod protobuf;
pub mod quantile;
pub mod record;
pub mod serve;
pub mod settings;
pub mod suggest;
pub mod truth;
pub mod web;
pub mod wiring;
pub mod words;
