//! Memory that DMA writes around in, and how far it was read.

use core::ptr::addr_of_mut;

use crate::port::Port;

/// Bytes of each: 1 ms of a full bus, 2.6 ms of a full line.
const LEN: usize = 512;

static mut BUS: [u8; LEN] = [0; LEN];
static mut LINE: [u8; LEN] = [0; LEN];

/// What came through a port.
pub struct Ring {
    port: Port,
    bytes: *const u8,
    read: usize,
}

impl Ring {
    /// The bus's, listening from now on.
    pub fn of_bus(port: Port, divider: u16, pins: [usize; 2]) -> Self {
        Self::open(port, divider, pins, addr_of_mut!(BUS))
    }

    /// The line's, listening from now on.
    pub fn of_line(port: Port, divider: u16, pins: [usize; 2]) -> Self {
        Self::open(port, divider, pins, addr_of_mut!(LINE))
    }

    fn open(port: Port, divider: u16, pins: [usize; 2], bytes: *mut [u8; LEN]) -> Self {
        port.open(divider, pins, bytes);
        Self { port, bytes: bytes.cast(), read: 0 }
    }

    /// Where the next byte will be written.
    pub fn end(&self) -> usize {
        (LEN - self.port.left()) % LEN
    }

    /// Bytes up to there that nobody has read.
    pub const fn waits(&self, end: usize) -> usize {
        (end + LEN - self.read) % LEN
    }

    /// Whether the last byte up to there ends a frame.
    pub fn is_whole(&self, end: usize) -> bool {
        self.waits(end) > 0 && self.at(end.wrapping_sub(1)) == 0
    }

    /// The next byte up to there.
    pub fn next(&mut self, end: usize) -> Option<u8> {
        if self.read == end {
            return None;
        }
        let byte = self.at(self.read);
        self.read = (self.read + 1) % LEN;
        Some(byte)
    }

    fn at(&self, place: usize) -> u8 {
        // SAFETY: within the ring, which DMA writes behind the compiler's back.
        unsafe { self.bytes.add(place % LEN).read_volatile() }
    }
}
