//! A board's line, seen from the PC: what comes up it, and what is sent down.

mod inbox;
mod outbox;

pub use inbox::{Counts, Heard, Inbox};
pub use outbox::Outbox;
