//! The chip's last two flash sectors, 6 and 7, as the log's flash. `memory.x` keeps the image out of them.
//!
//! The core stands still while a word is programmed (16 us, at most 100) and while a sector is erased (1 s, at most 2); interrupts wait,
//! DMA and timers go on. embassy's driver erases by bytes after a reset, twice as long, and waits for ever if the flash never gets ready.

use core::ptr::addr_of;

use embassy_stm32::Peri;
use embassy_stm32::pac::FLASH as INTERFACE;
use embassy_stm32::pac::flash::regs::Cr;
use embassy_stm32::pac::flash::vals::Psize;
use embassy_stm32::peripherals::FLASH;
use tenax_hal_shim::flash::{BLANK, FlashArea, FlashFailed, Sector};

use crate::deadline::clock_us;

unsafe extern "C" {
    static __store_start: u32;
}

const SECTOR_WORDS: usize = 128 * 1024 / 4;
/// The number of the first of them (RM0383, table 4).
const FIRST_SECTOR: u8 = 6;
const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];
/// Longer than any word and any sector takes (DS10314, flash memory programming).
const PATIENCE_WORD_US: u32 = 1_000;
const PATIENCE_SECTOR_US: u32 = 4_000_000;

pub struct Flash {
    _interface: Peri<'static, FLASH>,
}

impl Flash {
    pub fn new(interface: Peri<'static, FLASH>) -> Self {
        Self { _interface: interface }
    }

    /// Unlocks the interface for one operation, which `start` begins, and locks it again.
    fn operate(&mut self, control: Cr, patience_us: u32, start: impl FnOnce()) -> Result<(), FlashFailed> {
        if INTERFACE.cr().read().lock() {
            for key in KEYS {
                INTERFACE.keyr().write_value(key);
            }
        }
        // What an operation before this one left behind: flags are cleared by writing them.
        INTERFACE.sr().modify(|_| {});
        INTERFACE.cr().write_value(control);
        start();
        let begun = clock_us();
        while INTERFACE.sr().read().bsy() && clock_us().wrapping_sub(begun) <= patience_us {}
        let status = INTERFACE.sr().read();
        INTERFACE.cr().write(|w| w.set_lock(true));
        let failed = status.wrperr() || status.pgaerr() || status.pgperr() || status.pgserr();
        if !status.bsy() && !failed { Ok(()) } else { Err(FlashFailed) }
    }
}

/// The address of a word. None outside the sectors.
fn address(sector: Sector, word: usize) -> Option<*mut u32> {
    (word < SECTOR_WORDS)
        .then(|| addr_of!(__store_start).cast_mut().wrapping_add(sector as usize * SECTOR_WORDS + word))
}

impl FlashArea for Flash {
    fn sector_words(&self) -> usize {
        SECTOR_WORDS
    }

    fn read(&self, sector: Sector, word: usize) -> u32 {
        // SAFETY: an aligned word of the flash, which is always mapped. Only `self` changes it.
        address(sector, word).map_or(BLANK, |address| unsafe { address.read_volatile() })
    }

    fn program(&mut self, sector: Sector, word: usize, value: u32) -> Result<(), FlashFailed> {
        let address = address(sector, word).ok_or(FlashFailed)?;
        if self.read(sector, word) != BLANK {
            return Err(FlashFailed);
        }
        let mut control = Cr(0);
        control.set_pg(true);
        control.set_psize(Psize::PSIZE32);
        // SAFETY: an aligned word of the two sectors, which hold no code and no variable, and nobody else writes them.
        self.operate(control, PATIENCE_WORD_US, || unsafe { address.write_volatile(value) })
    }

    fn erase(&mut self, sector: Sector) -> Result<(), FlashFailed> {
        let mut control = Cr(0);
        control.set_ser(true);
        control.set_snb(FIRST_SECTOR + sector as u8);
        control.set_psize(Psize::PSIZE32);
        self.operate(control, PATIENCE_SECTOR_US, || INTERFACE.cr().modify(|w| w.set_strt(true)))
    }
}
