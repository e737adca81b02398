//! What came up a serial line, put where it belongs in a run.

use tenax_hal_shim::wire::Up;

use super::{Recorder, Summary};
use tenax_frames::link::Inbox;

pub struct LineLog {
    inbox: Inbox,
    frames: u32,
}

impl LineLog {
    pub fn new(frames: u32) -> Self {
        Self { inbox: Inbox::default(), frames }
    }

    /// Puts the messages in `bytes` where they belong.
    pub fn hear(&mut self, bytes: &[u8], summary: &mut Summary, recorder: &mut dyn Recorder) {
        summary.line_bytes += bytes.len();
        recorder.line(bytes);
        for heard in bytes.iter().filter_map(|&byte| self.inbox.push(byte)).flatten() {
            match heard.received.message {
                Up::Slow(slow) if slow.frame >= self.frames => {}
                Up::Event(event) if event.frame >= self.frames => {}
                message => summary.take(message, recorder),
            }
        }
        let counts = self.inbox.counts();
        summary.bad_frames = counts.bad_frames;
        summary.messages_missed = counts.missed;
    }
}
