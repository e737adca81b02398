//! Which chip this is, and which image.

use core::ptr::addr_of;

use tenax_hal_shim::wire::{Identity, ResetCause};

#[repr(C)]
struct Note {
    /// The lengths of its owner's name and of itself, its kind, the name `GNU`.
    header: [u32; 4],
    build: [u8; 8],
}

unsafe extern "C" {
    static __build_id: Note;
}

pub fn of(reset: ResetCause) -> Identity {
    // SAFETY: the note is in flash, is longer than this, and nobody writes it.
    let Note { header: _, build } = unsafe { addr_of!(__build_id).read() };
    let chip = embassy_stm32::uid::uid();
    let word = |n: usize| u32::from_le_bytes([chip[n], chip[n + 1], chip[n + 2], chip[n + 3]]);
    Identity { build: u64::from_be_bytes(build), chip: [word(0), word(4), word(8)], reset }
}
