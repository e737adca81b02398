//! Steady sliding: several films stay above their own floors, smoothed over 0.1 s, for 0.2 s. An object that
//! slides at 40 mm/s gives a tenth of the onset's envelope, so no threshold in volts would do. It is answered
//! as a warning, and only while closing helps ([`Asked`]): a grasp has one allowance, which slip renews.

use tenax_hal_shim::channel::PVDF_COUNT;
use tenax_hal_shim::wire::Forces;

use crate::emg::level::{LEVEL_Q, log2};
use crate::evidence::Sound;
use crate::force::Asked;

/// Slow frames over which floors are learned when a grasp begins: 0.3 s.
const LEARN_FRAMES: u16 = 24;
/// First of these slow frames, in which a floor jumps to the present level.
const LEAP_FRAMES: u16 = 4;
/// Low-passes, in slow frames, log2: a floor's way down, up while it is learned, up later (13 s), and the
/// level.
const DOWN_SHIFT: u32 = 2;
const LEARN_SHIFT: u32 = 4;
const UP_SHIFT: u32 = 10;
const SMOOTH_SHIFT: u32 = 3;
/// Fraction bits of a level, and of a level as a multiple of its floor.
const Q: u32 = 8;
const TIMES_Q: u32 = 6;
/// Least floor: 1 mV, more than the converter's own noise.
const LEAST_FLOOR: i32 = 5 << Q;
/// Films that have to agree.
const FILMS: u32 = 3;
/// Level from which a film is loud, in floors: alone, and together with noise above the band.
const LOUD: i32 = 6;
const LOUD_TOGETHER: i32 = 2;
const LOUD_ABOVE: i32 = 3;
/// Force beyond any warning's limit, mN: the rig's load swings by as much while it slides.
const ON_TOP_MN: i32 = 1_000;
/// Slow frames of loudness until sliding is reported, 0.2 s (longer than any impact), and of silence until
/// the report ends.
const BEGIN_FRAMES: u8 = 16;
const END_FRAMES: u8 = 8;
/// Levels over a floor that are told apart, octaves, Q10.
const LEVELS: core::ops::RangeInclusive<i32> = -(1 << LEVEL_Q)..=6 << LEVEL_Q;

#[derive(Clone, Copy, Debug)]
pub struct Hand {
    /// None while the finger holds nothing or the force is unknown.
    pub forces: Option<Forces>,
    pub wearer: bool,
    /// The reflex answers slip or lets the object settle, so the hand itself is loud.
    pub striking: bool,
    /// S1 is above its threshold.
    pub loud: bool,
}

#[derive(Clone, Copy, Debug, Default)]
struct Level {
    smooth: i32,
    floor: i32,
}

impl Level {
    /// Q16 samples, limited to `most` floors. The floor rises by `2^-up` of the difference.
    #[inline]
    fn step(&mut self, now: i32, up: u32, most: i32) -> Floors {
        let now = now >> (16 - Q);
        let shift = if now < self.floor { DOWN_SHIFT } else { up };
        self.floor += (now - self.floor) >> shift;
        let floor = self.floor.max(LEAST_FLOOR);
        // Limited: sliding is told from an impact by its duration, not its loudness.
        self.smooth += (now.min(most * floor) - self.smooth) >> SMOOTH_SHIFT;
        Floors { level: self.smooth, floor }
    }
}

/// Both are below 2^22, so that a few floors fit.
#[derive(Clone, Copy)]
struct Floors {
    level: i32,
    floor: i32,
}

impl Floors {
    const fn are_over(self, floors: i32) -> bool {
        self.level > floors * self.floor
    }
}

/// Octaves, Q10, of Q16 samples over a floor.
fn over(now: i32, floor: i32) -> i32 {
    let times = ((now.max(0) as u32) >> (16 - Q - TIMES_Q)) / floor.max(LEAST_FLOOR) as u32;
    (log2(times.max(1)) - ((TIMES_Q as i32) << LEVEL_Q)).clamp(*LEVELS.start(), *LEVELS.end())
}

#[derive(Clone, Debug, Default)]
pub struct Sliding {
    films: [Level; PVDF_COUNT],
    above: Level,
    learned_for: u16,
    lasted: u8,
    said: bool,
    pub sound: Sound,
    asked: Asked,
    /// Load of the last slow frame, its growth without a pause, and the largest one of a report, mN: of a pulse.
    last_mn: i32,
    grows_mn: i32,
    pulse_mn: i32,
}

impl Sliding {
    /// Envelopes of a slow frame in and above the slip band, Q16 samples. True: the object slides.
    pub fn step(&mut self, envelopes: &[i32; PVDF_COUNT], above: i32, hand: &Hand) -> bool {
        let Some(forces) = hand.forces.filter(|_| !hand.wearer) else {
            (self.learned_for, self.lasted, self.said) = (0, 0, false);
            (self.asked, self.pulse_mn) = (Asked::default(), 0);
            self.sound = Sound::default();
            return false;
        };
        self.sound =
            if self.learned_for < LEARN_FRAMES { Sound::default() } else { self.hear(envelopes, above) };
        if hand.striking {
            if hand.loud {
                (self.asked, self.pulse_mn) = (Asked::default(), 0);
            }
            return self.said;
        }
        let up = if self.learned_for < LEAP_FRAMES {
            DOWN_SHIFT
        } else if self.learned_for < LEARN_FRAMES {
            LEARN_SHIFT
        } else {
            UP_SHIFT
        };
        let (mut loud, mut together, mut loudest) = (0, 0, 0);
        for (film, &now) in self.films.iter_mut().zip(envelopes) {
            let heard = film.step(now, up, 2 * LOUD);
            loud += u32::from(heard.are_over(LOUD));
            together += u32::from(heard.are_over(LOUD_TOGETHER));
            loudest = loudest.max(heard.level);
        }
        let above = self.above.step(above, up, 2 * LOUD_ABOVE);
        self.learned_for = self.learned_for.saturating_add(1);
        if self.learned_for < LEARN_FRAMES {
            return false;
        }
        let sounds =
            above.level < loudest && (loud >= FILMS || (above.are_over(LOUD_ABOVE) && together >= FILMS));
        self.lasted = if sounds == self.said { 0 } else { self.lasted + 1 };
        if self.lasted >= if sounds { BEGIN_FRAMES } else { END_FRAMES } {
            (self.said, self.lasted) = (sounds, 0);
            self.asked.begin(&forces);
        }
        let grows = self.said && forces.load_mn > self.last_mn;
        self.grows_mn = if grows { self.grows_mn + forces.load_mn - self.last_mn } else { 0 };
        self.last_mn = forces.load_mn;
        self.pulse_mn = self.pulse_mn.max(self.grows_mn);
        // Another pulse would spend more than the allowance.
        let spent = self.asked.in_vain(&forces, ON_TOP_MN - self.pulse_mn);
        let may = !spent && !self.asked.is_held(&forces, ON_TOP_MN);
        self.said && may
    }

    /// Mean of the films that give a reading, and of the noise above the band.
    fn hear(&self, envelopes: &[i32; PVDF_COUNT], above: i32) -> Sound {
        let (mut sum, mut films) = (0, 0);
        for (film, &now) in self.films.iter().zip(envelopes) {
            if now != 0 {
                (sum, films) = (sum + over(now, film.floor), films + 1);
            }
        }
        Sound { rise: (sum / films.max(1)) as i16, above: over(above, self.above.floor) as i16 }
    }

    /// Closing has shown that nothing slides: what is heard is noise.
    pub fn refute(&mut self, envelopes: &[i32; PVDF_COUNT]) {
        for (film, &now) in self.films.iter_mut().zip(envelopes) {
            film.floor = film.floor.max(now >> (16 - Q));
        }
        (self.said, self.lasted) = (false, 0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MV: i32 = 5 << 16;

    /// Slow frames of one sound: in the band of so many films, and above it.
    fn after(sliding: &mut Sliding, frames: u32, films: usize, mv: i32, above_mv: i32, load_mn: i32) -> bool {
        let mut envelopes = [2 * MV; PVDF_COUNT];
        envelopes[..films].fill(mv * MV);
        let forces = Forces { fn_mn: load_mn, fx_mn: 0, fy_mn: 0, ft_mn: 0, load_mn, ratio_permille: None };
        let hand = Hand { forces: Some(forces), wearer: false, striking: false, loud: false };
        (0..frames).fold(false, |_, _| sliding.step(&envelopes, above_mv * MV, &hand))
    }

    #[test]
    fn films_that_stay_above_their_floors_slide_and_short_or_lonely_ones_do_not() {
        let mut sliding = Sliding::default();
        assert!(!after(&mut sliding, 400, 12, 2, 1, 4_000));
        assert!(!after(&mut sliding, 5, 12, 200, 20, 4_000), "an impact");
        assert!(!after(&mut sliding, 60, 12, 2, 1, 4_000));
        assert!(!after(&mut sliding, 400, 2, 40, 1, 4_000), "two films of twelve");
        assert!(!after(&mut sliding, 400, 12, 8, 12, 4_000), "it rings above the band");
        after(&mut sliding, 400, 12, 2, 1, 4_000);
        assert!(after(&mut sliding, 40, 12, 20, 1, 4_000), "a texture's tone");
        assert!(!after(&mut sliding, 40, 12, 2, 1, 4_000));
        assert!(after(&mut sliding, 40, 12, 6, 5, 4_000), "as on the rig: more of it above the band");
    }

    #[test]
    fn a_grasp_has_one_allowance_and_the_next_pulse_does_not_exceed_it() {
        let mut sliding = Sliding::default();
        after(&mut sliding, 400, 12, 2, 1, 4_000);
        assert!(after(&mut sliding, 24, 12, 20, 1, 4_000));
        let mut says = |load_mn| after(&mut sliding, 4, 12, 20, 1, load_mn);
        assert!(says(5_000));
        assert!(says(6_000), "a pulse of 1 N more ends at the limit");
        assert!(!says(6_010));
        after(&mut sliding, 160, 12, 2, 1, 6_010);
        assert!(!after(&mut sliding, 40, 12, 20, 1, 6_010), "quiet is no confirmation");
        assert!(after(&mut sliding, 40, 12, 20, 1, 4_000), "the hand let go as much");
    }
}
