//! A board's line, seen from the PC.
//!
//! [`Target`] opens it; [`Inbox`] receives messages, [`Outbox`] sends commands, and [`Client`] does both.

#[cfg(feature = "host")]
pub mod board;
pub mod captured;
#[cfg(feature = "host")]
mod client;
mod clock;
mod inbox;
mod outbox;
#[cfg(feature = "host")]
mod target;

#[cfg(feature = "host")]
pub use board::Board;
pub use captured::Captured;
#[cfg(feature = "host")]
pub use client::{ANSWER_WITHIN, Client, is_silence};
pub use clock::Clock;
pub use inbox::{Counts, Heard, Inbox};
pub use outbox::{Encoder, Outbox};
#[cfg(feature = "host")]
pub use target::{Line, Target, port_names};
