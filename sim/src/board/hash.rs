//! The hash of what a board decided, for the golden gate: of the host's build, and of the page's.

use std::fmt;

use tenax_scene::World;

use super::Run;

/// FNV-1a, 64 bits.
pub struct Hash(u64);

impl Hash {
    pub fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn message(&mut self, message: &impl serde::Serialize) {
        let mut buffer = [0; 2048];
        self.bytes(postcard::to_slice(message, &mut buffer).expect("a message is shorter"));
    }
}

impl fmt::Display for Hash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

pub fn of_run(run: &Run) -> Hash {
    let mut hash = Hash(0xcbf2_9ce4_8422_2325);
    run.slows.iter().for_each(|slow| hash.message(slow));
    run.events.iter().for_each(|event| hash.message(event));
    run.drives.iter().for_each(|drive| hash.message(drive));
    run.feedback.iter().for_each(|feedback| hash.message(feedback));
    hash
}

/// Everything that the board decided in a scene, and what came of it.
pub fn of_scene(run: &Run, world: &mut World) -> Hash {
    let mut hash = of_run(run);
    for row in world.take_trace() {
        hash.bytes(&((row.grip_n * 1e3).round() as i64).to_le_bytes());
        hash.bytes(&((row.slide_mm_s * 1e3).round() as i64).to_le_bytes());
    }
    hash
}
