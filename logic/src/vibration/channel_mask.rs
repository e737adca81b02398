//! Masks a PVDF channel that alone reports vibration again and again (hum, bad contact) until it is quiet.

use tenax_hal_shim::channel::{PVDF_COUNT, frames};

const ALONE_FRAMES: u32 = frames(150);
const QUIET_FRAMES: u32 = frames(10_000);
const WEIGHT: u32 = 8;

#[derive(Clone, Debug, Default)]
pub struct ChannelMask {
    pub masked: u16,
    suspect: u8,
    alone: u32,
    quiet: [u32; PVDF_COUNT],
}

impl ChannelMask {
    pub const fn is_masked(&self, channel: usize) -> bool {
        self.masked >> channel & 1 != 0
    }

    #[inline]
    pub const fn count_quiet(&mut self) {
        self.alone = self.alone.saturating_sub(1);
    }

    #[inline(never)]
    pub fn count_loud(&mut self, envelopes: &[i32; PVDF_COUNT], on: i32) {
        let mut above = envelopes.iter().enumerate().filter(|(_, own)| **own > on / 4);
        let (Some((channel, _)), None) = (above.next(), above.next()) else {
            return self.count_quiet();
        };
        if usize::from(self.suspect) != channel {
            (self.suspect, self.alone) = (channel as u8, 0);
        }
        self.alone += WEIGHT;
        if self.alone >= WEIGHT * ALONE_FRAMES {
            self.masked |= 1 << channel;
            self.quiet[channel] = 0;
            self.alone = 0;
        }
    }

    /// Unmasked when the envelope has been far below `on` for long enough; Q16 samples.
    pub fn check_masked(&mut self, channel: usize, envelope: i32, on: i32) {
        let Some(quiet) = self.quiet.get_mut(channel) else {
            return;
        };
        *quiet = if envelope < on / 8 { *quiet + 1 } else { 0 };
        if *quiet >= QUIET_FRAMES {
            self.masked &= !(1 << channel);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ON: i32 = 1_000;

    fn after(mask: &mut ChannelMask, frames: u32, envelopes: [i32; PVDF_COUNT]) -> u16 {
        (0..frames).for_each(|_| mask.count_loud(&envelopes, ON));
        mask.masked
    }

    #[test]
    fn one_channel_alone_is_masked_and_several_are_not() {
        let mut alone = [0; PVDF_COUNT];
        alone[3] = 2_000;
        let mut mask = ChannelMask::default();
        assert_eq!(after(&mut mask, ALONE_FRAMES - 1, alone), 0, "slip begins somewhere");
        assert_eq!(after(&mut mask, 1, alone), 1 << 3);
        let mut two = alone;
        two[7] = 300;
        assert_eq!(after(&mut ChannelMask::default(), 100_000, two), 0);
    }

    #[test]
    fn bursts_add_up_and_quiet_mends() {
        let mut alone = [0; PVDF_COUNT];
        alone[0] = 2_000;
        let mut mask = ChannelMask::default();
        for _ in 0..4 {
            after(&mut mask, ALONE_FRAMES / 2, alone);
            (0..ALONE_FRAMES / 2).for_each(|_| mask.count_quiet());
        }
        assert!(mask.is_masked(0));
        (0..QUIET_FRAMES - 1).for_each(|_| mask.check_masked(0, 100, ON));
        mask.check_masked(0, 200, ON);
        (0..QUIET_FRAMES - 1).for_each(|_| mask.check_masked(0, 100, ON));
        assert!(mask.is_masked(0));
        mask.check_masked(0, 100, ON);
        assert!(!mask.is_masked(0));
    }
}
