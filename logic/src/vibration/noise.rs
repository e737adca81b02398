//! Noise of the films, which S1's threshold is in units of: what stands for longer than the dips of a slip, what
//! the empty hand hears, and what one film reports alone again and again (bad contact).

use tenax_hal_shim::channel::{PVDF_COUNT, SLOW_HZ};

use super::Q;
use super::film::Film;

/// Slow frames of a block. A film's floor is its least envelope in the last block and this one: 0.2 to 0.4 s.
const BLOCK_FRAMES: u8 = 16;
/// Least threshold of S1, in floors.
const FLOORS: i32 = 3;
/// Low-passes of what the empty hand hears, in slow frames, log2: up, and down where it is quieter by half.
const EMPTY_UP_SHIFT: u32 = 3;
const EMPTY_DOWN_SHIFT: u32 = 6;
/// Slow frames of a floor above half of the set threshold until a film is noisy, 1.2 s. One that is loud alone
/// counts eightfold.
const NOISY_AFTER: u16 = 96;
const ALONE: u16 = 8;
/// Slow frames of quiet until it is noisy no more: 10 s.
const QUIET_FRAMES: u16 = 10 * SLOW_HZ as u16;
/// Blocks in which no hum of the mains that is set explains what stands, until the other mains is tried: 1.6 s.
const OTHER_AFTER: u8 = 8;

#[derive(Clone, Copy, Debug, Default)]
struct Own {
    least: i32,
    last: i32,
    /// Slow frames of noise; once it is noisy, of quiet that is still missing.
    blamed: u16,
}

#[derive(Clone, Debug, Default)]
pub struct Noise {
    films: [Own; PVDF_COUNT],
    frames: u8,
    empty: i32,
    unexplained: u8,
    pub noisy: u16,
    /// Noisy films that S1 does not hear: none if they are most of all, for then it needs more of each.
    pub left_out: u16,
    /// S1's threshold above the one that is set, Q16 samples.
    pub raised: i32,
    pub other_mains: bool,
}

impl Noise {
    /// What the films hear is no slip: the threshold is twice as much, until they are quieter.
    pub fn refute(&mut self, envelopes: &[i32; PVDF_COUNT]) {
        self.empty = envelopes.iter().fold(self.empty, |most, &now| most.max(now));
    }

    /// One slow frame. `set`: S1's threshold in the settings, samples.
    pub fn step(&mut self, films: &[Film; PVDF_COUNT], set: u16, empty_hand: bool) {
        let set = i32::from(set) << Q;
        let on = set + self.raised;
        self.frames = (self.frames + 1) % BLOCK_FRAMES;
        let is_one = films.iter().filter(|film| film.envelope > on / 4).count() == 1;
        let (mut floor, mut loudest, mut hum) = (0, 0, 0);
        for (n, (own, film)) in self.films.iter_mut().zip(films).enumerate() {
            let (bit, level) = (1 << n, film.envelope);
            own.least = own.least.min(level);
            let stands = own.least.min(own.last);
            if self.frames == 0 {
                (own.last, own.least) = (own.least, level);
            }
            if self.left_out & bit == 0 {
                (floor, loudest, hum) = (floor.max(stands), loudest.max(level), hum.max(film.hum.level()));
            }
            let noise = if is_one && level > on / 2 { ALONE } else { u16::from(stands > set / 2) };
            own.blamed = if self.noisy & bit != 0 && level > set / 8 {
                QUIET_FRAMES
            } else if noise > 0 {
                own.blamed + noise
            } else {
                own.blamed.saturating_sub(1)
            };
            if own.blamed >= NOISY_AFTER {
                self.noisy |= bit;
            } else if own.blamed == 0 {
                self.noisy &= !bit;
            }
        }
        let are_most = self.noisy.count_ones() > PVDF_COUNT as u32 / 2;
        self.left_out = if are_most { 0 } else { self.noisy };
        if empty_hand {
            self.empty += (loudest - self.empty).max(0) >> EMPTY_UP_SHIFT;
        }
        if loudest < self.empty / 2 {
            self.empty -= self.empty >> EMPTY_DOWN_SHIFT;
        }
        self.raised = set.max(FLOORS * floor).max(2 * self.empty) - set;
        if self.frames == 0 {
            self.unexplained = if floor > set / 2 && hum < floor { self.unexplained + 1 } else { 0 };
            if self.unexplained == OTHER_AFTER {
                (self.unexplained, self.other_mains) = (0, !self.other_mains);
            }
        }
    }
}
