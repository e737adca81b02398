//! A bus of two wires, byte by byte: who sends at the same time as another garbles both.

use tenax_palm::bus::BAUD;

/// Places in time in which a byte is sent, a second.
pub const SLOT_HZ: u32 = BAUD / 10;

/// Who sends.
#[derive(Clone, Debug, Default)]
struct Driver {
    bytes: Vec<u8>,
    next: usize,
    begins: u64,
    /// Its driver stays on, whatever it has to say.
    is_stuck: bool,
}

/// The wires, and everybody's driver.
#[derive(Clone, Debug)]
pub struct Wires {
    drivers: Vec<Driver>,
    pub is_cut: bool,
}

impl Wires {
    pub fn new(count: usize) -> Self {
        Self { drivers: vec![Driver::default(); count], is_cut: false }
    }

    /// Sends bytes from this slot on. What it was sending is over.
    pub fn send(&mut self, who: usize, bytes: &[u8], begins: u64) {
        let driver = &mut self.drivers[who];
        (driver.bytes, driver.next, driver.begins) = (bytes.to_vec(), 0, begins);
    }

    /// Its driver does not let go of the wires any more.
    pub fn stick(&mut self, who: usize) {
        self.drivers[who].is_stuck = true;
    }

    /// Whether it has something left to send.
    pub fn is_sending(&self, who: usize) -> bool {
        let driver = &self.drivers[who];
        driver.next < driver.bytes.len()
    }

    /// The byte that is over at the end of this slot, and who sent it if it was one alone.
    pub fn step(&mut self, slot: u64) -> Option<(u8, Option<usize>)> {
        let mut heard: Option<(u8, Option<usize>)> = None;
        let mut is_stuck = false;
        for (who, driver) in self.drivers.iter_mut().enumerate() {
            is_stuck |= driver.is_stuck;
            if driver.begins > slot || driver.next >= driver.bytes.len() {
                continue;
            }
            let byte = driver.bytes[driver.next];
            driver.next += 1;
            heard = Some(match heard {
                None => (byte, Some(who)),
                // Two drivers pull the wires apart: neither's byte.
                Some((other, _)) => (other ^ byte ^ 0x55, None),
            });
        }
        let heard = heard.filter(|_| !self.is_cut);
        if is_stuck { heard.map(|(byte, _)| (byte | 0x81, None)) } else { heard }
    }
}
