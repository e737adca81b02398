//! The fingers that a PC names, across a reset: the erase that keeping them takes is not the watchdog's to wait for.

use core::mem::MaybeUninit;
use core::ptr::{addr_of, addr_of_mut};

use tenax_palm::places::{Kept, Places, WORDS, pack, unpack};

/// What a reset does not clear: not initialised by the runtime. Its frame's CRC says whether it is one.
#[unsafe(link_section = ".uninit.places")]
static mut HANDED: MaybeUninit<Kept> = MaybeUninit::uninit();

/// For the next start.
pub fn give(places: &Places) {
    if let Some(kept) = pack(places) {
        // SAFETY: nothing interrupts this image, and a reset comes next.
        unsafe { addr_of_mut!(HANDED).cast::<Kept>().write_volatile(kept) };
    }
}

/// What the run before this one was given, once.
pub fn take() -> Option<Kept> {
    // SAFETY: any bits are words, and nobody else reads or writes them.
    let kept = unsafe { addr_of!(HANDED).cast::<Kept>().read_volatile() };
    // SAFETY: as above.
    unsafe { addr_of_mut!(HANDED).cast::<Kept>().write_volatile([0; WORDS]) };
    unpack(kept.iter().copied()).map(|_| kept)
}
