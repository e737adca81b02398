//! Stiffness of the grasp, learned while the motor closes: the steepest rise of the force over the duty,
//! since the motor's dead time flattens the others.

use crate::latest;

/// Readings over which a rise is taken, 37.5 ms: as long as a pulse, which a shorter span would see in parts.
const SPAN: usize = 3;
/// Longest dead time, 100 ms.
const DEAD: usize = 8;
/// Readings of travel that are kept: the longest dead time, and the span.
const KEPT: usize = DEAD + SPAN;
/// Readings in which the force does not show the travel yet, before a closing has shown them: a dead time of 30 ms, and the
/// time of a reading.
const NOT_FELT: u8 = 3;
/// Part of the rise after a stop that shows when the dead time is over, per mille.
const RISEN_PERMILLE: i32 = 850;
const NOISE_MN: i32 = 60;
/// Least travel whose rise tells anything: 1.5 ms at full duty.
const TRAVEL_MIN: u32 = 3_000;
const FRACTION: u32 = 4;
/// 4 N a frame at full duty.
const MOST: u32 = 4_000 << FRACTION;

/// Travel is in per mille of duty times frames.
#[derive(Clone, Copy, Debug)]
pub struct Stiffness {
    /// Force that a frame at full duty adds, mN with [`FRACTION`] bits; 0 before the first closing.
    mn_a_frame: u32,
    steepest: u32,
    /// Travel of this reading's time, and of those before, the newest first.
    travel: u32,
    before: [u32; KEPT],
    loads_mn: [i32; SPAN],
    /// Readings in which the force does not show the travel yet.
    not_felt: u8,
    /// Loads since the motor stopped, mN, and how many.
    stopped_mn: [i32; DEAD + 1],
    stopped: u8,
}

impl Default for Stiffness {
    fn default() -> Self {
        Self {
            mn_a_frame: 0,
            steepest: 0,
            travel: 0,
            before: [0; KEPT],
            loads_mn: [0; SPAN],
            not_felt: NOT_FELT,
            stopped_mn: [0; DEAD + 1],
            stopped: 0,
        }
    }
}

impl Stiffness {
    pub const fn close(&mut self, duty_permille: u16) {
        self.travel += duty_permille as u32;
    }

    /// mN; None while nothing is held. Call it once a slow frame.
    #[inline(never)]
    pub fn feel(&mut self, load_mn: Option<i32>) {
        let travel = core::mem::take(&mut self.travel);
        latest::push(&mut self.before, travel);
        self.time(load_mn.unwrap_or(0));
        let Some(load_mn) = load_mn else {
            (self.mn_a_frame, self.steepest, self.loads_mn) = (0, 0, [0; SPAN]);
            return;
        };
        let [.., oldest_mn] = self.loads_mn;
        latest::push(&mut self.loads_mn, load_mn);
        // The newest two are left out: the motor has not moved yet, the object changes the force.
        let most = self.before[2..].windows(SPAN).map(|travel| travel.iter().sum()).max().unwrap_or(0);
        let rise_mn = load_mn - oldest_mn;
        if oldest_mn > 0 && rise_mn > NOISE_MN && most >= TRAVEL_MIN {
            // A load is below 2^17 mN, the product below 2^31.
            let shown = rise_mn.unsigned_abs() * (1_000 << FRACTION) / most;
            self.steepest = self.steepest.max(shown.min(MOST));
            self.mn_a_frame = self.mn_a_frame.max(self.steepest);
        }
        if self.before == [0; KEPT] && self.steepest > 0 {
            self.mn_a_frame = core::mem::take(&mut self.steepest);
        }
    }

    /// The dead time, by the load's rise after the motor has stopped.
    fn time(&mut self, load_mn: i32) {
        let [now, before, ..] = self.before;
        if now > 0 {
            self.stopped = 0;
            return;
        }
        if before > 0 {
            self.stopped = 1;
            self.stopped_mn[0] = self.loads_mn[0];
        }
        let n = usize::from(self.stopped);
        let Some(slot) = self.stopped_mn.get_mut(n).filter(|_| n > 0) else { return };
        (*slot, self.stopped) = (load_mn, self.stopped + 1);
        let [first_mn, .., last_mn] = self.stopped_mn;
        let rise_mn = last_mn - first_mn;
        if n == DEAD && rise_mn > 2 * NOISE_MN && rise_mn > last_mn / 16 {
            let risen = |&mn: &i32| {
                i64::from(mn - first_mn) * 1_000 >= i64::from(rise_mn) * i64::from(RISEN_PERMILLE)
            };
            // A reading's travel is not measured before the next.
            self.not_felt = self.stopped_mn.iter().position(risen).map_or(NOT_FELT, |after| after as u8 + 1);
        }
    }

    /// Travel that adds this force, mN, less the travel that the force does not show yet. None before a
    /// closing has shown the stiffness.
    pub fn travel_for(&self, lacks_mn: i32) -> Option<u32> {
        let coming = self.before.iter().take(self.not_felt.into()).sum::<u32>() + self.travel;
        let lacks_mn = lacks_mn.clamp(0, 1 << 17).unsigned_abs();
        (lacks_mn * (1_000 << FRACTION))
            .checked_div(self.mn_a_frame)
            .map(|travel| travel.saturating_sub(coming))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn closing(
        stiffness: &mut Stiffness,
        load_mn: &mut f64,
        duty_permille: u16,
        frames: usize,
        mn_a_frame: f64,
        dead: usize,
    ) {
        for n in 0..frames + dead + KEPT {
            if n < frames {
                (0..25).for_each(|_| stiffness.close(duty_permille));
            }
            if (dead..dead + frames).contains(&n) {
                *load_mn += 25.0 * mn_a_frame * f64::from(duty_permille) / 1e3;
            }
            stiffness.feel(Some(*load_mn as i32));
        }
    }

    #[test]
    fn closing_shows_the_stiffness_whatever_the_dead_time() {
        for dead in 2..=4 {
            for (duty, frames) in [(100, 40), (500, 10), (1_000, 4), (1_000, 3)] {
                for mn_a_frame in [18.0, 90.0, 360.0] {
                    let (mut stiffness, mut load_mn) = (Stiffness::default(), 700.0);
                    assert_eq!(stiffness.travel_for(1_000), None);
                    closing(&mut stiffness, &mut load_mn, duty, frames, mn_a_frame, dead);
                    let shown = 1e6 / f64::from(stiffness.travel_for(1_000).unwrap());
                    assert!(
                        (shown / mn_a_frame - 1.0).abs() < 0.1,
                        "{dead} {duty} {frames}: {shown} for {mn_a_frame}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_newest_closing_counts_and_another_object_is_another_stiffness() {
        let (mut stiffness, mut load_mn) = (Stiffness::default(), 700.0);
        closing(&mut stiffness, &mut load_mn, 500, 10, 90.0, 2);
        closing(&mut stiffness, &mut load_mn, 500, 10, 45.0, 2);
        let travel = stiffness.travel_for(900).unwrap();
        assert!((19_000..=21_000).contains(&travel), "{travel}");
        (0..10).for_each(|_| stiffness.close(1_000));
        assert_eq!(stiffness.travel_for(900), Some(travel - 10_000));
        stiffness.feel(None);
        assert_eq!(stiffness.travel_for(900), None);
    }

    #[test]
    fn a_load_that_jumps_as_the_motor_starts_is_the_objects() {
        let (mut stiffness, mut load_mn) = (Stiffness::default(), 700.0);
        closing(&mut stiffness, &mut load_mn, 100, 40, 18.0, 2);
        let before = stiffness.travel_for(1_000);
        (0..5).for_each(|_| stiffness.close(1_000));
        stiffness.feel(Some(load_mn as i32 + 150));
        stiffness.feel(Some(load_mn as i32 + 150));
        assert!(stiffness.travel_for(1_000) <= before);
        assert_eq!(stiffness.mn_a_frame, before.map(|travel| (1_000_000 << FRACTION) / travel).unwrap());
    }

    #[test]
    fn a_rise_within_the_noise_shows_no_stiffness() {
        for (rise_mn, is_shown) in [(NOISE_MN, false), (NOISE_MN + 1, true)] {
            let mut stiffness =
                Stiffness { loads_mn: [1_000; SPAN], before: [TRAVEL_MIN; KEPT], ..Stiffness::default() };
            stiffness.feel(Some(1_000 + rise_mn));
            assert_eq!(stiffness.travel_for(1_000).is_some(), is_shown, "{rise_mn} mN");
        }
    }
}
