//! Masks a PVDF channel that alone reports vibration again and again: it is broken, and nothing slips.
//!
//! Slip begins in one place, but the next pulse of the reflex ends it, or all channels come to show it. One that goes on
//! alone has hum, a bad contact or a cracked film: it may close the hand once, and is masked from then on until it has been
//! quiet for a while.

use tenax_hal_shim::channel::PVDF_COUNT;

use tenax_hal_shim::channel::frames;

/// Time for which a channel may be loud alone before it is masked, frames.
const ALONE_FRAMES: u32 = frames(150);
/// Time of silence after which a masked channel is believed again, frames.
const QUIET_FRAMES: u32 = frames(10_000);
/// Weight of a frame in which the channel is loud alone against one in which it is not.
const WEIGHT: u32 = 8;

/// Masked channels, and the count of loud frames of the channel that is loud alone.
#[derive(Clone, Debug, Default)]
pub struct ChannelMask {
    masked: u16,
    suspect: u8,
    alone: u32,
    quiet: [u32; PVDF_COUNT],
}

impl ChannelMask {
    /// The masked channels, one bit each, film 1 lowest.
    pub const fn masked(&self) -> u16 {
        self.masked
    }

    /// Whether this channel is masked.
    #[must_use]
    pub const fn is_masked(&self, channel: usize) -> bool {
        self.masked >> channel & 1 != 0
    }

    /// Counts a frame in which no channel is loud.
    #[inline]
    pub const fn count_quiet(&mut self) {
        self.alone = self.alone.saturating_sub(1);
    }

    /// Counts a frame in which a channel's envelope is above `on`, Q16 samples.
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

    /// Takes a masked channel's envelope, Q16 samples. It is unmasked when it has been far below `on` for long enough.
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
        mask.masked()
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
