//! CDR with its four bytes of representation, as a ROS 2 payload has it. Nothing that comes is trusted.

use byteorder::{BigEndian, LittleEndian};
use cdr_encoding::{from_bytes, to_vec};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Plain CDR, little-endian, no options.
const LITTLE: [u8; 4] = [0, 1, 0, 0];
const BIG: [u8; 2] = [0, 0];
/// A longer payload than this is none that a hand takes.
const PAYLOAD_MAX: usize = 1 << 16;

/// A message's payload. None for what CDR cannot say, which no message of [`crate::message`] is.
pub fn payload(message: &impl Serialize) -> Option<Vec<u8>> {
    let body = to_vec::<_, LittleEndian>(message).ok()?;
    Some([&LITTLE[..], &body].concat())
}

/// The message of a payload, of either byte order. None where it is none, or is longer than its message and the padding behind it.
pub fn message<M: DeserializeOwned>(payload: &[u8]) -> Option<M> {
    if payload.len() > PAYLOAD_MAX {
        return None;
    }
    let (head, body) = payload.split_at_checked(LITTLE.len())?;
    let (message, taken) = match head {
        [0, 1, ..] => from_bytes::<M, LittleEndian>(body).ok()?,
        [a, b, ..] if [*a, *b] == BIG => from_bytes::<M, BigEndian>(body).ok()?,
        _ => return None,
    };
    (body.len() < taken + 4).then_some(message)
}
