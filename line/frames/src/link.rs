//! A board's line, seen from the PC.
//!
//! [`Target`] opens it; [`Inbox`] receives messages, [`Outbox`] sends commands, and [`Client`] does both.

pub mod board;
pub mod captured;
mod client;
mod clock;
mod inbox;
mod outbox;
mod target;

pub use board::Board;
pub use captured::Captured;
pub use client::{ANSWER_WITHIN, Client, is_silence};
pub use clock::Clock;
pub use inbox::{Counts, Heard, Inbox};
pub use outbox::{Encoder, Outbox};
pub use target::{Line, Target, port_names};
