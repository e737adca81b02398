//! A board's line, seen from the PC: what comes up it, and what is sent down.
//!
//! [`Target`] opens it; [`Inbox`] takes what comes up, [`Outbox`] sends commands, and [`Client`] does both.

pub mod captured;
mod client;
mod encoder;
mod holder;
mod inbox;
mod last;
mod outbox;
mod target;

pub use client::{ANSWER_WITHIN, Client, is_silence};
pub use encoder::Encoder;
pub use inbox::{Counts, Heard, Inbox};
pub use last::LastSeconds;
pub use outbox::Outbox;
pub use target::{Line, Target};
