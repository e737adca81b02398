//! What the detectors are given, built from frames outside the fingertip.

use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::wire::Down;
use tenax_host_tests::Bench;
use tenax_logic::config::Config;
use tenax_logic::detectors::{Detectors, Sensed};
use tenax_logic::journal::Journal;
use tenax_logic::senses::Senses;
use tenax_logic::store::record::{PAYLOAD_BYTES, Record};

/// The senses alone: no reflex, no motor.
#[derive(Debug, Default)]
pub struct Sensing {
    pub config: Config,
    senses: Senses,
    journal: Journal,
}

impl Sensing {
    /// Takes a frame that came in whole, while nobody moves the hand.
    pub fn take(&mut self, frame: &Frame) -> Sensed<'_> {
        self.journal.begin(frame);
        self.senses.process(&self.config, frame, &mut self.journal);
        self.senses.sensed(&self.config, frame, 0, false)
    }
}

/// Every detector, the Hebbian one with what the fingertip of a bench was taught.
pub fn taught_detectors(seed: u64) -> Detectors {
    let mut fingertip = Bench::taught(seed).fingertip;
    let mut keeper = fingertip.keeper();
    fingertip.command(&Down::Save).expect("never refused");
    let mut detectors = Detectors::default();
    while let Some(record) = fingertip.next_record(&mut keeper) {
        if let Record::Network(_) = record {
            let mut buffer = [0; PAYLOAD_BYTES];
            assert!(detectors.hebbian.restore(record.payload(&mut buffer)), "a network's record");
        }
    }
    detectors
}
