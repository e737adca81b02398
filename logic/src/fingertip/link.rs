//! The drive of the serial line, and the time for which the line may silence the reflex, by drives and behaviours together.

use tenax_hal_shim::motor::MotorDrive;

use tenax_hal_shim::channel::frames;

/// Longest silence of the reflex in all, until a muscle, a consent or as much listening renews it.
const HOLD_FRAMES_MAX: u32 = frames(10_000);
/// Longest silence for a stroke that began within it.
const STROKE_FRAMES_MAX: u32 = frames(60_000);
/// A shorter pause is part of the silence: the reflex would still be settling.
const PAUSE_FRAMES: u32 = frames(500);

#[derive(Clone, Copy, Debug)]
pub struct Link {
    drive: MotorDrive,
    frames_left: u32,
    /// Frames of the reflex's silence, less those for which it has listened since.
    held: u32,
    listened: u32,
    exhausted: bool,
}

impl Default for Link {
    fn default() -> Self {
        Self { drive: MotorDrive::Coast, frames_left: 0, held: 0, listened: PAUSE_FRAMES, exhausted: false }
    }
}

impl Link {
    /// `Coast` ends the command before.
    pub fn ask(&mut self, drive: MotorDrive, frames: u32) {
        self.drive = drive;
        self.frames_left = frames;
    }

    /// `silences`: a behaviour silences the reflex.
    pub fn tick(&mut self, silences: bool) {
        // The usual tick.
        if !silences
            && self.frames_left == 0
            && self.held == 0
            && self.drive == MotorDrive::Coast
            && self.listened >= PAUSE_FRAMES
        {
            return;
        }
        if self.frames_left == 0 || self.exhausted {
            self.drive = MotorDrive::Coast;
        }
        self.frames_left = self.frames_left.saturating_sub(1);
        let listens = self.drive == MotorDrive::Coast && !silences;
        self.listened = if listens { self.listened.saturating_add(1) } else { 0 };
        if self.listened < PAUSE_FRAMES {
            self.held = (self.held + 1).min(STROKE_FRAMES_MAX);
            self.exhausted |= self.held >= HOLD_FRAMES_MAX;
        } else {
            self.held = self.held.min(HOLD_FRAMES_MAX).saturating_sub(1);
            self.exhausted &= self.held > 0;
        }
    }

    pub const fn renew(&mut self) {
        self.held = 0;
        self.exhausted = false;
    }

    pub const fn is_exhausted(&self) -> bool {
        self.exhausted
    }

    pub const fn ends_stroke(&self) -> bool {
        self.held >= STROKE_FRAMES_MAX
    }

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
            link.tick(false);
            driven += u32::from(link.drive().is_some());
        }
        driven
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
    fn as_much_listening_renews_it() {
        let mut link = Link::default();
        driven(&mut link, 500, 500, HOLD_FRAMES_MAX);
        (0..HOLD_FRAMES_MAX + PAUSE_FRAMES).for_each(|_| link.tick(false));
        assert!(!link.is_exhausted());
        assert_eq!(driven(&mut link, 500, 500, 500), 500);
    }
}
