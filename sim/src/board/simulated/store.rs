//! The host board's store: saves in as many ticks as the image takes, into a flash that is gone when the run is over.

use tenax_hal_shim::flash::FlashFailed;
use tenax_hal_shim::wire::{Event, EventKind, Up};
use tenax_hal_shim::words::{Fault, Kept};
use tenax_logic::store::record::{OVERHEAD_WORDS, PAYLOAD_BYTES, Record};
use tenax_logic::store::{Erase, Log, Refused, open};

use crate::board::kept::Sectors;

/// Ticks from one word to the next (`firmware/src/store.rs`).
const TICKS_PER_WORD: u32 = 4;

pub struct Store {
    flash: Sectors,
    log: Log,
    saving: Option<(Record, u32)>,
    saved: Option<(Kept, Vec<u8>)>,
}

impl Store {
    pub fn new(mut flash: Sectors) -> Self {
        let (log, _) = open(&mut flash, Erase::Allowed);
        Self { flash, log, saving: None, saved: None }
    }

    pub fn is_free(&self) -> bool {
        self.saving.is_none()
    }

    pub fn save(&mut self, record: Record) {
        let words =
            record.payload(&mut [0; PAYLOAD_BYTES]).len() / 4 + OVERHEAD_WORDS + self.log.mark_words();
        self.saving = Some((record, TICKS_PER_WORD * words as u32));
    }

    pub fn end_tick(&mut self, frame: u32) -> Option<Up> {
        let (_, left) = self.saving.as_mut()?;
        *left = left.saturating_sub(1);
        if *left > 0 {
            return None;
        }
        let (record, _) = self.saving.take()?;
        let kept = record.kept();
        let fault = |fault| Up::Event(Event { frame, kind: EventKind::Fault(fault) });
        let mut buffer = [0; PAYLOAD_BYTES];
        let payload = record.payload(&mut buffer);
        Some(match self.write(kept, payload) {
            Ok(()) => {
                self.saved = Some((kept, payload.to_vec()));
                Up::Saved { frame, kept }
            }
            Err(Refused::Full) => fault(Fault::StoreFull(kept)),
            Err(Refused::Failed | Refused::Length) => fault(Fault::StoreFailed(kept)),
        })
    }

    pub fn saved(&mut self) -> Option<(Kept, Vec<u8>)> {
        self.saved.take()
    }

    fn write(&mut self, kept: Kept, payload: &[u8]) -> Result<(), Refused> {
        let mut saving = self.log.begin(kept, payload)?;
        while !saving.step(&mut self.flash).map_err(|FlashFailed| Refused::Failed)? {}
        Ok(())
    }
}
