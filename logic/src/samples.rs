//! The last sample of every channel, on request over the line.

use tenax_hal_shim::channel::{CHANNELS, COUNT, Input, PVDF_COUNT, SWITCH_INPUTS};
use tenax_hal_shim::frame::Frame;

#[derive(Clone, Debug, Default)]
pub struct LastSamples {
    pvdf: [u16; PVDF_COUNT],
    switch_a: [u16; SWITCH_INPUTS as usize],
    pub switch_b: [u16; SWITCH_INPUTS as usize],
}

impl LastSamples {
    pub fn record(&mut self, frame: &Frame) {
        if !frame.valid {
            return;
        }
        let select = usize::from(frame.select());
        self.pvdf = frame.pvdf;
        self.switch_a[select] = frame.switch_a;
        self.switch_b[select] = frame.switch_b;
    }

    /// Last 14-bit samples in the order of [`CHANNELS`]; 0 for a channel without a sample yet.
    pub fn in_order(&self) -> [u16; COUNT] {
        let last = |samples: &[u16], place: u8| samples.get(usize::from(place)).copied().unwrap_or(0);
        CHANNELS.map(|channel| match channel.input {
            Input::Direct { rank } => last(&self.pvdf, rank),
            Input::SwitchA { select } => last(&self.switch_a, select),
            Input::SwitchB { select } => last(&self.switch_b, select),
        })
    }
}
