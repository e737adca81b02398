//! The last sample of every channel, for whoever asks over the line.

use tenax_hal_shim::channel::{CHANNELS, COUNT, Input};
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::wire::Up;

/// The last samples, each as old as its channel is slow.
pub struct LastSamples {
    frame: u32,
    samples: [u16; COUNT],
}

impl Default for LastSamples {
    fn default() -> Self {
        Self { frame: 0, samples: [0; COUNT] }
    }
}

impl LastSamples {
    /// Takes in what a frame read.
    pub fn take(&mut self, frame: &Frame) {
        if !frame.valid {
            return;
        }
        self.frame = frame.sequence;
        let shown = frame.select();
        for (sample, channel) in self.samples.iter_mut().zip(&CHANNELS) {
            match channel.input {
                Input::Direct { rank } => *sample = frame.pvdf[usize::from(rank)],
                Input::SwitchA { select } if select == shown => *sample = frame.switch_a,
                Input::SwitchB { select } if select == shown => *sample = frame.switch_b,
                Input::SwitchA { .. } | Input::SwitchB { .. } => {}
            }
        }
    }

    /// The answer to [`Down::Samples`](tenax_hal_shim::wire::Down::Samples).
    pub fn message(&self) -> Up {
        Up::Samples { frame: self.frame, samples: self.samples }
    }
}
