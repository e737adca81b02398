//! The drive of the serial line, and the time for which it may silence the reflex.

use tenax_hal_shim::motor::MotorDrive;

use tenax_hal_shim::channel::frames;

/// Longest drive by the line in all, in frames, until a muscle, a consent or as much silence renews it.
const HOLD_FRAMES_MAX: u32 = frames(10_000);
/// A pause between two drives shorter than this is part of the hold, in frames: the reflex would still be settling.
const PAUSE_FRAMES: u32 = frames(500);

/// The last drive command of the serial line, and the number of frames for which it still holds.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    drive: MotorDrive,
    frames_left: u32,
    /// Frames held, less those of silence since.
    held: u32,
    quiet: u32,
    exhausted: bool,
}

impl Default for Link {
    fn default() -> Self {
        Self { drive: MotorDrive::Coast, frames_left: 0, held: 0, quiet: PAUSE_FRAMES, exhausted: false }
    }
}

impl Link {
    /// Takes a drive command that holds for `frames` frames. `Coast` ends the one before.
    pub fn ask(&mut self, drive: MotorDrive, frames: u32) {
        self.drive = drive;
        self.frames_left = frames;
    }

    /// Counts one frame off; without any left the drive is `Coast`.
    pub fn tick(&mut self) {
        // The usual tick: no command holds, and the time held before has run down.
        if self.frames_left == 0
            && self.held == 0
            && self.drive == MotorDrive::Coast
            && self.quiet >= PAUSE_FRAMES
        {
            return;
        }
        if self.frames_left == 0 || self.exhausted {
            self.drive = MotorDrive::Coast;
        }
        self.frames_left = self.frames_left.saturating_sub(1);
        self.quiet = if self.drive == MotorDrive::Coast { self.quiet.saturating_add(1) } else { 0 };
        if self.quiet < PAUSE_FRAMES {
            self.held = (self.held + 1).min(HOLD_FRAMES_MAX);
            self.exhausted |= self.held >= HOLD_FRAMES_MAX;
        } else {
            self.held = self.held.saturating_sub(1);
            self.exhausted &= self.held > 0;
        }
    }

    /// Renews the time: a muscle is active, or consent was given.
    pub const fn renew(&mut self) {
        self.held = 0;
        self.exhausted = false;
    }

    /// Whether its time is used up.
    #[must_use]
    pub const fn is_exhausted(&self) -> bool {
        self.exhausted
    }

    /// The drive that holds. None: the line asks for nothing.
    #[must_use]
    pub fn drive(&self) -> Option<MotorDrive> {
        (self.drive != MotorDrive::Coast).then_some(self.drive)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_hal_shim::motor::Duty;

    const CLOSE: MotorDrive = MotorDrive::Close(Duty::FULL);

    /// Asks for `on` frames of every `period`; how many frames of `total` were driven.
    fn driven(link: &mut Link, on: u32, period: u32, total: u32) -> u32 {
        let mut driven = 0;
        for n in 0..total {
            if n % period == 0 && !link.is_exhausted() {
                link.ask(CLOSE, on);
            }
            link.tick();
            driven += u32::from(link.drive().is_some());
        }
        driven
    }

    #[test]
    fn a_drive_lasts_as_long_as_it_says_and_coasting_asks_for_nothing() {
        let mut link = Link::default();
        assert_eq!(driven(&mut link, 100, 1_000, 1_000), 100);
        link.ask(CLOSE, 100);
        link.ask(MotorDrive::Coast, 500);
        link.tick();
        assert_eq!(link.drive(), None);
    }

    #[test]
    fn neither_a_long_hold_nor_many_short_ones_go_on_for_ever() {
        for (on, period) in [(500, 500), (1, 160), (1, PAUSE_FRAMES)] {
            let mut link = Link::default();
            driven(&mut link, on, period, HOLD_FRAMES_MAX);
            assert!(link.is_exhausted(), "{on} of {period}");
            assert_eq!(driven(&mut link, on, period, HOLD_FRAMES_MAX), 0, "{on} of {period}");
            link.renew();
            assert!(driven(&mut link, on, period, period) > 0);
        }
    }

    #[test]
    fn as_much_silence_renews_it() {
        let mut link = Link::default();
        driven(&mut link, 500, 500, HOLD_FRAMES_MAX);
        (0..HOLD_FRAMES_MAX + PAUSE_FRAMES).for_each(|_| link.tick());
        assert!(!link.is_exhausted());
        assert_eq!(driven(&mut link, 500, 500, 500), 500);
    }
}
