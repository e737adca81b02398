//! What the flash holds when somebody has set the board up before: that its serial line is trusted.

use tenax_hal_shim::flash::{BLANK, FlashArea, FlashFailed, Sector};
use tenax_hal_shim::setting::SettingId;
use tenax_hal_shim::words::Kept;
use tenax_logic::config::Config;
use tenax_logic::store::{open, payload};

/// Where `memory.x` puts the store.
pub const STORE: u64 = 0x0804_0000;
const SECTOR_WORDS: usize = 128 * 1024 / 4;

/// The store's two sectors as a file would hold them.
#[derive(Clone, Debug)]
pub struct Sectors(pub Vec<u32>);

impl Sectors {
    /// As they come from the factory.
    #[must_use]
    pub fn blank() -> Self {
        Self(vec![BLANK; 2 * SECTOR_WORDS])
    }

    /// With the setting that trusts the line, and nothing else.
    #[must_use]
    pub fn trusting() -> Self {
        let mut config = Config::default();
        // It is in every range.
        let _accepted = config.set(SettingId::LineTrusted, 1);
        Self::blank().saving(Kept::Settings, &payload::of_settings(&config))
    }

    /// With one more record, written by the host's own build of the store. Blank sectors have room for it.
    #[must_use]
    pub fn saving(mut self, kept: Kept, payload: &[u8]) -> Self {
        let (mut log, _) = open(&mut self);
        if let Ok(mut saving) = log.begin(kept, payload) {
            while saving.step(&mut self) == Ok(false) {}
        }
        self
    }

    /// The bytes, and where they are.
    #[must_use]
    pub fn image(&self) -> (u64, Vec<u8>) {
        (STORE, self.0.iter().flat_map(|word| word.to_le_bytes()).collect())
    }
}

impl FlashArea for Sectors {
    fn sector_words(&self) -> usize {
        SECTOR_WORDS
    }

    fn read(&self, sector: Sector, word: usize) -> u32 {
        self.0[sector as usize * SECTOR_WORDS + word]
    }

    fn program(&mut self, sector: Sector, word: usize, value: u32) -> Result<(), FlashFailed> {
        self.0[sector as usize * SECTOR_WORDS + word] &= value;
        Ok(())
    }

    fn erase(&mut self, sector: Sector) -> Result<(), FlashFailed> {
        self.0[sector as usize * SECTOR_WORDS..][..SECTOR_WORDS].fill(BLANK);
        Ok(())
    }
}
