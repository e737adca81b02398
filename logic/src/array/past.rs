use tenax_hal_shim::channel::{ARRAY, CHANNELS, sample_from_mv};

use super::{ELEMENTS, Reading};

pub const LAG_MAX: usize = 40;
const FRAMES: usize = LAG_MAX + 1;

#[derive(Clone, Debug)]
pub struct Past {
    frames: [[u16; ELEMENTS]; FRAMES],
    newest: usize,
    runs: [u8; ELEMENTS],
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Arrival {
    pub dead: usize,
    pub gone: [bool; ELEMENTS],
    /// Change of the elements' sum, samples. An element without a reading keeps its last value.
    pub change: i32,
    /// Part of `change` from elements that had no reading in the slow frame before, samples.
    pub missed: i32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Changes {
    /// Samples; 0 for an element that lacked a reading in between.
    pub of: [i32; ELEMENTS],
    pub known: i32,
}

impl Default for Past {
    fn default() -> Self {
        let rest = sample_from_mv(CHANNELS[ARRAY].rest_mv);
        Self { frames: [[rest; ELEMENTS]; FRAMES], newest: 0, runs: [0; ELEMENTS] }
    }
}

impl Past {
    pub fn push(&mut self, reading: &Reading) -> Arrival {
        let mut arrival = Arrival::default();
        let mut now = self.frames.get(self.newest).copied().unwrap_or_default();
        let elements = now.iter_mut().zip(&mut self.runs).zip(reading).zip(&mut arrival.gone);
        for (((last, run), reading), gone) in elements {
            let Some(sample) = *reading else {
                *gone = *run > 0;
                *run = 0;
                arrival.dead += 1;
                continue;
            };
            let change = i32::from(sample) - i32::from(*last);
            arrival.change += change;
            if *run == 0 {
                arrival.missed += change;
            }
            *run = (*run + 1).min(FRAMES as u8);
            *last = sample;
        }
        self.newest = if self.newest + 1 < FRAMES { self.newest + 1 } else { 0 };
        if let Some(frame) = self.frames.get_mut(self.newest) {
            *frame = now;
        }
        arrival
    }

    /// Change of each element over `lag` slow frames, clamped to 1..=[`LAG_MAX`] (Bamshad 2023, equation 1:
    /// 1).
    #[inline]
    pub fn changes(&self, lag: usize) -> Changes {
        let lag = lag.clamp(1, LAG_MAX);
        let mut changes = Changes { of: [0; ELEMENTS], known: 0 };
        let before = if self.newest >= lag { self.newest - lag } else { self.newest + FRAMES - lag };
        let (Some(now), Some(then)) = (self.frames.get(self.newest), self.frames.get(before)) else {
            return changes;
        };
        for (((change, now), then), &run) in changes.of.iter_mut().zip(now).zip(then).zip(&self.runs) {
            if usize::from(run) > lag {
                *change = i32::from(*now) - i32::from(*then);
                changes.known += 1;
            }
        }
        changes
    }
}
