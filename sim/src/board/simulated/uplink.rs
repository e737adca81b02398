//! The host board's line up, numbered and encoded as the image does it. Its counters have frames, ticks and what came down alone, and
//! come at other instants within a slow frame.

use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::wire::{Counters, Up};

use crate::board::{Recorder, Summary};
use tenax_frames::link::Encoder;

const COUNTERS_FRAMES: u32 = FRAME_HZ / 10;

pub struct Uplink {
    encoder: Encoder,
    pub summary: Summary,
}

impl Uplink {
    pub fn new(summary: Summary, recorder: &mut dyn Recorder) -> Self {
        let mut uplink = Self { encoder: Encoder::default(), summary };
        // The image ends whatever frame a reset may have cut short.
        uplink.summary.line_bytes += 1;
        recorder.line(&[0]);
        uplink.post(Up::Hello { frame_hz: FRAME_HZ as u16, after: None }, recorder);
        uplink
    }

    pub fn post(&mut self, message: Up, recorder: &mut dyn Recorder) {
        let (_, frame) = self.encoder.frame(&message);
        self.summary.line_bytes += frame.len();
        recorder.line(frame);
        self.summary.take(message, recorder);
    }

    pub fn count(&mut self, counters: Counters, recorder: &mut dyn Recorder) {
        if counters.frames > 0 && counters.frames.is_multiple_of(COUNTERS_FRAMES) {
            self.post(Up::Counters(counters), recorder);
        }
    }
}
