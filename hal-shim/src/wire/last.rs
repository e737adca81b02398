//! What the board had said before a fault: it survives the reset, and is fetched piece by piece.

use heapless::Vec;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use crate::words::Fault;

/// Bytes in one piece at most.
pub const PIECE_MAX: usize = 256;

/// Bytes of why it ended, at most.
pub const WHY_MAX: usize = 48;

/// A piece of what had gone up the line before the last run ended in a fault.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Last {
    /// The fault. None: nothing is kept.
    pub after: Option<Fault>,
    /// Why, in ASCII: where in the source it panicked, where the core faulted. Empty: nobody could say.
    pub why: Vec<u8, WHY_MAX>,
    /// Bytes that are kept, in all.
    pub length: u16,
    /// Where this piece begins in them.
    pub from: u16,
    /// Frames as they went up the line, the oldest first. The first of all may be torn.
    pub bytes: Vec<u8, PIECE_MAX>,
}

impl Last {
    /// Nothing is kept.
    #[must_use]
    pub const fn nothing(from: u16) -> Self {
        Self { after: None, why: Vec::new(), length: 0, from, bytes: Vec::new() }
    }
}
