//! The store task: what has to outlive a power cut goes into flash, a word every few ticks.
//! Programming a word stalls the core, so each begins within 0.25 ms after a tick's end, when the next frame is 0.1 ms away or more: even
//! at its longest, 0.1 ms, it is over before control is needed again. Nothing is erased while the hand works.
//! Runs in thread. Owns the log in flash. Never erases, and never begins a word but behind a tick.

use tenax_hal_shim::flash::FlashFailed;
use tenax_hal_shim::wire::{Event, EventKind, KEPT_MAX, Restored, Up};
use tenax_hal_shim::words::{Fault, Kept};
use tenax_logic::device::Device;
use tenax_logic::store::record::{PAYLOAD_BYTES, Record};
use tenax_logic::store::{Found, Log, Refused};

use crate::deadline::clock_us;
use crate::flash::Flash;
use crate::timing::{TICKS_PER_WORD, WORD_BEGINS_US};
use crate::{counts, mail};

const _: () = assert!(PAYLOAD_BYTES <= KEPT_MAX);

pub fn restore(device: &mut Device, flash: &Flash, found: &Found) {
    let mut buffer = [0; PAYLOAD_BYTES];
    for kept in Kept::ALL {
        if found.is_damaged(kept) {
            device.fingertip.report(Fault::RecordDamaged(kept));
        }
        if let Some(payload) = found.read(flash, kept, &mut buffer) {
            device.restore(kept, payload);
        }
    }
}

#[inline(never)]
pub fn restored(flash: &Flash, found: &Found, tell: impl Fn(Up)) {
    let mut buffer = [0; PAYLOAD_BYTES];
    for kept in Kept::ALL {
        if let Some(payload) = found.read(flash, kept, &mut buffer)
            && let Some(restored) = Restored::of(kept, payload)
        {
            tell(Up::Restored(restored));
        }
    }
}

#[embassy_executor::task]
pub async fn store(mut flash: Flash, mut log: Log) -> ! {
    loop {
        let record = mail::next_record().await;
        let kept = record.kept();
        let saved = save(&mut flash, &mut log, &record).await;
        let frame = counts::last_frame();
        let fault = |fault| Up::Event(Event { frame, kind: EventKind::Fault(fault) });
        mail::post_beside_control(match saved {
            Ok(()) => Up::Saved { frame, kept },
            Err(Refused::Full) => fault(Fault::StoreFull(kept)),
            Err(Refused::Failed | Refused::Length) => fault(Fault::StoreFailed(kept)),
        });
    }
}

async fn save(flash: &mut Flash, log: &mut Log, record: &Record) -> Result<(), Refused> {
    let mut buffer = [0; PAYLOAD_BYTES];
    let mut saving = log.begin(record.kept(), record.payload(&mut buffer))?;
    loop {
        for _ in 1..TICKS_PER_WORD {
            mail::tick_over().await;
        }
        let mut ended_us = mail::tick_over().await;
        // Telemetry may have been in the middle of its longest message: 18 000 instructions, 0.18 to 0.36 ms. Argued, not seen: no word
        // of a run with everything on the line has waited for it, at 50 million instructions a second neither.
        while clock_us().wrapping_sub(ended_us) > WORD_BEGINS_US {
            ended_us = mail::tick_over().await;
        }
        match saving.step(flash) {
            Ok(true) => return Ok(()),
            Ok(false) => {}
            Err(FlashFailed) => return Err(Refused::Failed),
        }
    }
}
