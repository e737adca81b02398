//! The samples that a board gives to the logic every 0.5 ms.

use crate::channel::{
    CHANNELS, CODE_MAX, COUNT, FRAMES_PER_SLOW_FRAME, HIGH_SELECT, Input, PVDF_COUNT, RANK_SWITCH_A,
    RANK_SWITCH_B, SCAN_LEN, SCANS_PER_FRAME,
};
use crate::schedule::select_of_slot;

/// One scan's codes, 12 bits each, in the order of [`SCAN`](crate::channel::SCAN).
pub type Scan = [u16; SCAN_LEN];

/// One frame: four scans added up, 0.5 ms, each sample 0 to [`SAMPLE_MAX`](crate::channel::SAMPLE_MAX).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Frames since the scan was started, gaps included.
    pub sequence: u32,
    /// Whether all four scans are of this frame. After an overrun the samples mean nothing until this is true again.
    pub valid: bool,
    pub pvdf: [u16; PVDF_COUNT],
    pub switch_a: u16,
    pub switch_b: u16,
}

/// Pairs of codes in a scan: the films', then the two switches'.
pub const PAIRS: usize = SCAN_LEN / 2;
const _: () = assert!(
    PVDF_COUNT.is_multiple_of(2)
        && RANK_SWITCH_A == PVDF_COUNT
        && RANK_SWITCH_B == RANK_SWITCH_A + 1
        && SCAN_LEN == PVDF_COUNT + 2
);

const fn halves(word: u32) -> [u16; 2] {
    [word as u16, (word >> 16) as u16]
}

impl Frame {
    pub fn from_scans(sequence: u32, scans: &[Scan; SCANS_PER_FRAME]) -> Self {
        Self::from_pairs(sequence, |scan, pair| {
            let [first, second] = [2 * pair, 2 * pair + 1].map(|rank| u32::from(scans[scan][rank]));
            first | second << 16
        })
    }

    /// Adds up a frame's scans, two codes at a time: `pair_of(scan, n)` is the codes of ranks `2 n` and `2 n + 1`, the
    /// first in the lower half, as they lie in a little-endian memory. Each is asked for once.
    #[inline]
    pub fn from_pairs(sequence: u32, pair_of: impl Fn(usize, usize) -> u32) -> Self {
        // Four codes of 12 bits stay in their half of the word.
        let sums: [u32; PAIRS] =
            core::array::from_fn(|n| (0..SCANS_PER_FRAME).map(|scan| pair_of(scan, n)).sum());
        let mut pvdf = [0; PVDF_COUNT];
        for (samples, sum) in pvdf.as_chunks_mut().0.iter_mut().zip(sums) {
            *samples = halves(sum);
        }
        let [switch_a, switch_b] = halves(sums[PAIRS - 1]);
        Self { sequence, valid: true, pvdf, switch_a, switch_b }
    }

    /// A lost frame with this number: its samples are not valid.
    pub const fn lost(sequence: u32) -> Self {
        Self { sequence, valid: false, pvdf: [0; PVDF_COUNT], switch_a: 0, switch_b: 0 }
    }

    /// Its slot in the slow frame, 0 to 24.
    pub const fn slot(&self) -> u8 {
        (self.sequence % FRAMES_PER_SLOW_FRAME as u32) as u8
    }

    /// State of the select lines while it was sampled, 0 to 15.
    pub const fn select(&self) -> u8 {
        select_of_slot(self.slot())
    }

    pub const fn ends_slow_frame(&self) -> bool {
        self.slot() == FRAMES_PER_SLOW_FRAME - 1
    }
}

/// The codes of one scan if the channels' pins have the codes in `pins` (0 to 4095) and the select lines show `select` (0 to 15).
///
/// This is the wiring seen from outside, with the inputs of known voltage: an emulated or simulated board uses it to put pins on the converter.
pub fn scan_of_pins(pins: &[u16; COUNT], select: u8) -> Scan {
    let mut scan = [0; SCAN_LEN];
    if select == HIGH_SELECT {
        scan[RANK_SWITCH_B] = CODE_MAX;
    }
    for (channel, &code) in CHANNELS.iter().zip(pins) {
        match channel.input {
            Input::Direct { rank } => scan[usize::from(rank)] = code,
            Input::SwitchA { select: own } if own == select => scan[RANK_SWITCH_A] = code,
            Input::SwitchB { select: own } if own == select => scan[RANK_SWITCH_B] = code,
            Input::SwitchA { .. } | Input::SwitchB { .. } => {}
        }
    }
    scan
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::channel::{FSR, MYO_EXTENSOR, MYO_SELECT};
    use core::array;

    #[test]
    fn each_rank_is_summed_by_itself_up_to_full_scale() {
        let falling: [Scan; SCANS_PER_FRAME] =
            array::from_fn(|scan| array::from_fn(|rank| 4_095 - (100 * scan + 7 * rank) as u16));
        for scans in [falling, [[4_095; SCAN_LEN]; SCANS_PER_FRAME]] {
            let frame = Frame::from_scans(7, &scans);
            let sum = |rank: usize| scans.iter().map(|scan| scan[rank]).sum::<u16>();
            assert_eq!(frame.pvdf, array::from_fn(sum));
            assert_eq!((frame.switch_a, frame.switch_b), (sum(RANK_SWITCH_A), sum(RANK_SWITCH_B)));
        }
    }

    #[test]
    fn a_switch_shows_the_selected_channel_only() {
        let mut pins = [0; COUNT];
        pins[MYO_EXTENSOR] = 123;
        pins[FSR] = 45;
        assert_eq!(scan_of_pins(&pins, MYO_SELECT + 1)[RANK_SWITCH_B], 123);
        assert_eq!(scan_of_pins(&pins, MYO_SELECT)[RANK_SWITCH_B], 0);
        assert_eq!(scan_of_pins(&pins, 12)[RANK_SWITCH_A], 45);
    }
}
