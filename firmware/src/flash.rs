//! The chip's last two flash sectors, 6 and 7, as the log's flash, through embassy's driver. `memory.x` keeps the image out of them.
//! The core stands still while a word is programmed (16 us, at most 100) and while a sector is erased, by bytes (2 s, at most 4; DS10314,
//! flash memory programming); interrupts wait, DMA and timers go on.
//! Runs at the start and in the store (thread). Owns the flash interface, but not the option bytes. Never runs while the supply is low.

use core::ptr::addr_of;

use embassy_stm32::flash::{Blocking, Flash as Driver};
use tenax_hal_shim::flash::{BLANK, FlashArea, FlashFailed, Sector};

unsafe extern "C" {
    static __store_start: u32;
}

const SECTOR_BYTES: u32 = 128 * 1024;
const SECTOR_WORDS: usize = SECTOR_BYTES as usize / 4;
/// The first of them, from the flash's start (RM0383, table 4).
const OFFSET: u32 = 256 * 1024;

pub struct Flash(pub Driver<'static, Blocking>);

/// Bytes from the flash's start. None outside the sectors.
fn offset(sector: Sector, word: usize) -> Option<u32> {
    (word < SECTOR_WORDS).then(|| OFFSET + sector as u32 * SECTOR_BYTES + 4 * word as u32)
}

impl FlashArea for Flash {
    fn sector_words(&self) -> usize {
        SECTOR_WORDS
    }

    fn read(&self, sector: Sector, word: usize) -> u32 {
        let Some(at) = offset(sector, word) else { return BLANK };
        let store = addr_of!(__store_start).cast::<u8>();
        // SAFETY: an aligned word of the two sectors, which are always mapped. Only `self` changes it.
        unsafe { store.add((at - OFFSET) as usize).cast::<u32>().read_volatile() }
    }

    fn program(&mut self, sector: Sector, word: usize, value: u32) -> Result<(), FlashFailed> {
        let at = offset(sector, word).filter(|_| self.read(sector, word) == BLANK).ok_or(FlashFailed)?;
        self.0.blocking_write(at, &value.to_le_bytes()).map_err(|_| FlashFailed)
    }

    fn erase(&mut self, sector: Sector) -> Result<(), FlashFailed> {
        let from = offset(sector, 0).ok_or(FlashFailed)?;
        self.0.blocking_erase(from, from + SECTOR_BYTES).map_err(|_| FlashFailed)
    }
}
