//! COBS (Cheshire and Baker 1999) around postcard. The encoder's state machine is the crate's: postcard's own flavor around it indexes its
//! buffer, which is a way to panic, and is inlined into every field of every message, 20 kB of flash.

use cobs::{EncoderState, PushResult};
use postcard::ser_flavors::Flavor;
use postcard::{Error, Result};

/// Encodes the bytes that are pushed as COBS into a buffer. A push fails if the buffer is full.
pub struct Stuffed<'b> {
    buffer: &'b mut [u8],
    length: usize,
    state: EncoderState,
}

impl<'b> Stuffed<'b> {
    pub fn new(buffer: &'b mut [u8]) -> Self {
        // The state machine counts from behind its first code byte.
        Self { buffer, length: 1, state: EncoderState::default() }
    }

    fn put(&mut self, at: usize, byte: u8) -> Result<()> {
        *self.buffer.get_mut(at).ok_or(Error::SerializeBufferFull)? = byte;
        Ok(())
    }

    fn append(&mut self, byte: u8) -> Result<()> {
        self.put(self.length, byte)?;
        self.length += 1;
        Ok(())
    }
}

impl<'b> Flavor for Stuffed<'b> {
    type Output = &'b mut [u8];

    #[inline(never)]
    fn try_push(&mut self, byte: u8) -> Result<()> {
        match self.state.push(byte) {
            PushResult::AddSingle(byte) => return self.append(byte),
            PushResult::ModifyFromStartAndSkip((at, code)) => self.put(at, code)?,
            PushResult::ModifyFromStartAndPushAndSkip((at, code, byte)) => {
                self.put(at, code)?;
                self.append(byte)?;
            }
        }
        // The place of the next code byte.
        self.append(0)
    }

    fn finalize(mut self) -> Result<Self::Output> {
        let (at, code) = self.state.clone().finalize();
        self.put(at, code)?;
        self.append(0)?;
        self.buffer.get_mut(..self.length).ok_or(Error::SerializeBufferFull)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use postcard::ser_flavors::{Cobs, Slice};
    use std::vec::Vec;

    fn encoded<F: Flavor<Output = impl AsRef<[u8]>>>(mut flavor: F, bytes: &[u8]) -> Option<Vec<u8>> {
        flavor.try_extend(bytes).ok()?;
        flavor.finalize().ok().map(|frame| frame.as_ref().to_vec())
    }

    #[test]
    fn bytes_are_those_of_postcards_flavor() {
        for length in (0..=20).chain(250..=260).chain(505..=513) {
            let some_zero = |n: usize| if n.is_multiple_of(3) { 0 } else { 7 };
            for byte in [|n: usize| n as u8 | 1, |_| 0, some_zero] {
                let bytes: Vec<u8> = (0..length).map(byte).collect();
                let mut buffer = [0; 600];
                let expected = encoded(Cobs::try_new(Slice::new(&mut buffer)).unwrap(), &bytes).unwrap();
                let in_room = |room: usize| encoded(Stuffed::new(&mut std::vec![0xAA; room]), &bytes);
                assert_eq!(in_room(expected.len()).as_ref(), Some(&expected));
                assert_eq!(in_room(expected.len() - 1), None);
            }
        }
    }
}
