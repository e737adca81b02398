//! Release of the force that the reflex added, if `relax-choice` allows it: after [`QUIET_READINGS`] without
//! a report, in small steps, down to the load that the friction of sliding needs, never below the load that
//! the hand was closed to, and never by more travel than the reflex closed. No load rises by itself: what is
//! read beyond what the motor added is drift, and is not released.

use super::stiffness::Stiffness;

/// Readings without a report before a release: 5 s.
const QUIET_READINGS: u16 = 400;
/// Readings between two steps, 0.25 s: a step's travel, the motor's dead time, and the force that follows.
const STEP_READINGS: u16 = 20;
/// Largest step, mN, and the least that is worth one.
const STEP_MN: i32 = 200;
const LEAST_MN: i32 = 100;
/// Load that is kept, as a part of what the friction of sliding needs, per mille: an object that is pulled
/// loose comes to rest by itself.
const KEPT_PERMILLE: i32 = 1_060;
const DUTY_PERMILLE: u16 = 100;
/// Drift that is followed in a reading, mN, 0.5 N/s, and the rise beyond it that is another load.
const DRIFTS_MN: i32 = 6;
const ANOTHER_MN: i32 = 100;
/// Readings after a movement in which it may change the load; longer than [`STEP_READINGS`], so that between two
/// steps the drift of the time before goes on.
const MOVES_READINGS: u8 = 30;
/// Average of the rise in a reading over `2^RISES_SHIFT` readings, 1.6 s.
const RISES_SHIFT: u32 = 7;
/// A load is below 2^17 mN.
const Q: u32 = 12;

#[derive(Clone, Copy, Debug)]
pub struct Reading {
    pub load_mn: i32,
    pub ft_mn: i32,
    /// Friction at which the object slid in this grasp, per mille.
    pub slid_permille: Option<u16>,
}

#[derive(Clone, Copy, Debug, Default)]
pub struct Relax {
    /// Load that the hand was closed to, or that it had before a step that a detector answered, mN.
    floor_mn: Option<i32>,
    before_mn: i32,
    /// Load without what it has risen by itself, mN.
    counted_mn: i32,
    /// Rise of the load by itself since the hand was closed, and in a reading, mN with [`Q`] fraction bits.
    risen: i32,
    rises: i32,
    /// Readings until the motor's last movement shows in the load.
    moves: u8,
    /// Greatest shear of the last seconds and of those before, mN.
    most_mn: [i32; 2],
    quiet: u16,
    /// Travel that the reflex has closed and not released, per mille of duty times frames.
    closed: u32,
    /// Travel left of this step, per mille of duty times frames.
    left: u32,
}

impl Relax {
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    pub const fn closes(&mut self, duty_permille: u16) {
        self.closed = self.closed.saturating_add(duty_permille as u32);
        (self.left, self.moves) = (0, MOVES_READINGS);
    }

    /// Call it when a detector reports slip or a warning. The load before the last step becomes the floor:
    /// the step went too far.
    pub fn hear(&mut self) {
        self.floor_mn = self.floor_mn.map(|floor_mn| floor_mn.max(self.before_mn));
        (self.quiet, self.left) = (0, 0);
    }

    /// Call it once a slow frame while no source moves the hand.
    #[inline(never)]
    pub fn feel(&mut self, reading: &Reading, stiffness: &Stiffness) {
        let Reading { load_mn, ft_mn, slid_permille } = *reading;
        let [newest, before] = &mut self.most_mn;
        *newest = ft_mn.max(*newest);
        let most_mn = (*newest).max(*before);
        if self.quiet.is_multiple_of(QUIET_READINGS) {
            (*before, *newest) = (*newest, ft_mn);
        }
        let counted_mn = self.count(load_mn);
        let floor_mn = *self.floor_mn.get_or_insert(counted_mn);
        self.quiet = if self.quiet < 2 * QUIET_READINGS { self.quiet + 1 } else { QUIET_READINGS + 1 };
        if self.quiet <= QUIET_READINGS || !self.quiet.is_multiple_of(STEP_READINGS) {
            return;
        }
        let Some(slid) = slid_permille.filter(|&slid| slid > 0) else { return };
        // A shear is below 2^17 mN, the product below 2^31.
        let needed_mn = most_mn.clamp(0, 1 << 17) * KEPT_PERMILLE / i32::from(slid);
        let step_mn = (counted_mn - needed_mn.max(floor_mn)).min(STEP_MN);
        if step_mn >= LEAST_MN {
            self.before_mn = counted_mn;
            self.moves = MOVES_READINGS;
            self.left = stiffness.travel_for(step_mn).unwrap_or(0).min(self.closed);
        }
    }

    /// The load without what it has risen by itself, mN.
    fn count(&mut self, load_mn: i32) -> i32 {
        self.moves = if self.left > 0 { MOVES_READINGS } else { self.moves.saturating_sub(1) };
        let off_mn = load_mn - self.counted_mn - (self.risen >> Q);
        if self.moves > 0 || off_mn > ANOTHER_MN || self.floor_mn.is_none() {
            self.risen += self.rises;
            self.counted_mn = load_mn - (self.risen >> Q);
        } else {
            let risen = (self.risen + (off_mn.clamp(-DRIFTS_MN, DRIFTS_MN) << Q)).max(0);
            self.rises = (self.rises + ((risen - self.risen - self.rises) >> RISES_SHIFT)).max(0);
            self.risen = risen;
            self.counted_mn -= (self.counted_mn - load_mn).clamp(0, DRIFTS_MN);
        }
        self.counted_mn.min(load_mn)
    }

    pub const fn is_on(&self) -> bool {
        self.left > 0
    }

    /// Duty of this frame, per mille; 0: none. Call it once a frame.
    pub fn opens(&mut self) -> u16 {
        let duty = (self.left.min(DUTY_PERMILLE.into())) as u16;
        self.left -= u32::from(duty);
        self.closed = self.closed.saturating_sub(duty.into());
        duty
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SILENT: usize = QUIET_READINGS as usize;

    /// A hand that was closed to 6 N, then by the reflex to 16 N; 50 mN a frame at full duty.
    struct Hand {
        relax: Relax,
        stiffness: Stiffness,
        load_mn: i32,
        /// Drift of the reading, in each reading and until now, mN.
        drifts_mn: f64,
        drift_mn: f64,
    }

    impl Hand {
        fn squeezed() -> Self {
            let (relax, stiffness) = Default::default();
            let mut hand = Self { relax, stiffness, load_mn: 6_000, drifts_mn: 0.0, drift_mn: 0.0 };
            hand.feel(3_000, None, 1);
            for n in 0..8 {
                for _ in 0..25 {
                    hand.stiffness.close(1_000);
                    hand.relax.closes(1_000);
                }
                hand.load_mn += 1_250;
                hand.stiffness.feel(Some(6_000 + 1_250 * (n - 2).max(0)));
            }
            hand.relax.hear();
            (0..10).for_each(|_| hand.stiffness.feel(Some(16_000)));
            hand
        }

        /// So many readings; gives the frames in which it opened.
        fn feel(&mut self, ft_mn: i32, slid_permille: Option<u16>, readings: usize) -> usize {
            let mut opened = 0;
            for _ in 0..readings {
                self.drift_mn += self.drifts_mn;
                let load_mn = self.load_mn + self.drift_mn as i32;
                let reading = Reading { load_mn, ft_mn, slid_permille };
                self.relax.feel(&reading, &self.stiffness);
                for _ in 0..25 {
                    let duty = self.relax.opens();
                    opened += usize::from(duty > 0);
                    self.load_mn -= i32::from(duty) * 50 / 1_000;
                }
            }
            opened
        }
    }

    #[test]
    fn after_silence_it_opens_to_what_stops_a_sliding_object() {
        let mut hand = Hand::squeezed();
        assert_eq!(hand.feel(2_000, Some(200), SILENT), 0, "5 s of silence");
        assert!(hand.feel(2_000, Some(200), 10 * SILENT) > 0);
        let needed_mn = 2_000 * KEPT_PERMILLE / 200;
        assert!((needed_mn..needed_mn + STEP_MN).contains(&hand.load_mn), "{} mN", hand.load_mn);
    }

    #[test]
    fn without_friction_it_opens_nothing_and_never_below_what_the_hand_was_closed_to() {
        let mut hand = Hand::squeezed();
        assert_eq!(hand.feel(2_000, None, 10 * SILENT), 0);
        hand.feel(100, Some(200), 10 * SILENT);
        assert!((6_000..6_000 + STEP_MN).contains(&hand.load_mn), "{} mN", hand.load_mn);
    }

    #[test]
    fn a_word_ends_it_and_the_load_before_its_step_is_kept() {
        let mut hand = Hand::squeezed();
        while hand.feel(2_000, Some(200), 1) == 0 {}
        let (heard_mn, before_mn) = (hand.load_mn, hand.relax.before_mn);
        hand.relax.hear();
        assert!(heard_mn < before_mn && !hand.relax.is_on());
        hand.load_mn += 3_000;
        hand.feel(100, Some(200), 10 * SILENT);
        assert!(hand.load_mn >= before_mn, "{} mN", hand.load_mn);
    }

    #[test]
    fn what_a_reading_gains_by_itself_is_not_released() {
        // 20 to 400 mN/s, over 25 s.
        for drifts_mn in [0.25, 1.0, 5.0] {
            let mut hand = Hand::squeezed();
            hand.drifts_mn = drifts_mn;
            assert!(hand.feel(2_000, Some(200), 5 * SILENT) > 0);
            let needed_mn = 2_000 * 1_000 / 200;
            assert!(hand.load_mn >= needed_mn, "{drifts_mn}: {} mN", hand.load_mn);
        }
    }

    #[test]
    fn it_opens_no_more_than_the_reflex_closed() {
        let mut hand = Hand::squeezed();
        hand.relax.closed = 3_000;
        assert_eq!(hand.feel(100, Some(200), 10 * SILENT), 3_000 / usize::from(DUTY_PERMILLE));
    }

    #[test]
    fn a_step_comes_with_every_twentieth_quiet_reading_for_as_long_as_it_is_quiet() {
        let stepped = |slid_permille: Option<u16>| {
            let Hand { mut relax, stiffness, .. } = Hand::squeezed();
            relax.floor_mn = Some(6_000);
            let is_on = |_: &u16| {
                relax.left = 0;
                relax.feel(&Reading { load_mn: 16_000, ft_mn: 2_000, slid_permille }, &stiffness);
                relax.is_on()
            };
            (1..=5 * QUIET_READINGS).filter(is_on).collect::<std::vec::Vec<_>>()
        };
        let expected: std::vec::Vec<u16> =
            (QUIET_READINGS + STEP_READINGS..=5 * QUIET_READINGS).step_by(STEP_READINGS.into()).collect();
        assert_eq!(stepped(Some(200)), expected);
        assert_eq!(stepped(Some(0)), [], "no friction");
    }
}
