//! The board's messages before a fault: they survive the reset and are read piece by piece.

use heapless::Vec;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use crate::words::Fault;

pub const PIECE_MAX: usize = 256;

pub const WHY_MAX: usize = 48;

/// A piece of the board's last messages before a fault ended its last run.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Last {
    /// The fault. None: nothing is kept.
    pub after: Option<Fault>,
    /// Place of the fault in ASCII: source line of a panic, address of a core fault. Empty: unknown.
    pub why: Vec<u8, WHY_MAX>,
    /// Total bytes kept.
    pub length: u16,
    /// Offset of this piece, bytes.
    pub from: u16,
    /// Encoded frames as they went up the line, the oldest first. The oldest of all may lack its beginning.
    pub bytes: Vec<u8, PIECE_MAX>,
}

impl Last {
    pub const fn nothing(from: u16) -> Self {
        Self { after: None, why: Vec::new(), length: 0, from, bytes: Vec::new() }
    }
}
