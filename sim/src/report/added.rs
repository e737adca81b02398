//! What the reflex added to the grip, and how much of it without need.

use serde::Serialize;
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::Slow;
use tenax_hal_shim::words::DriveSource;
use tenax_scene::truth::{Row, TRACE_HZ};

use super::fate::Fate;
use crate::board::Recorder;
use crate::timeline::{frame_end_s, ticks};

/// The force that a pulse added is there after this long, frames: the motor's dead time and the settling.
const SETTLED_FRAMES: u32 = FRAME_HZ * 15 / 100;
/// Time before a micro onset, and after a slip's end, in which a pulse still answers the slip, s.
pub(super) const BEFORE_S: f64 = 0.050;
/// Safety ratio: a grip up to 1.1 times the largest need within [`ABOUT_S`] counts as needed.
const ABOUT_PART: f64 = 1.1;
const ABOUT_S: f64 = 1.0;
const NOTICED_N: f64 = 0.1;

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Sums {
    pub added_n: f64,
    /// Those added with no slip within 50 ms, above 1.1 times the need of the next second. Null where the truth is not known.
    pub added_without_need_n: Option<f64>,
    /// Closings that added more than 0.1 N of that.
    pub closings_without_need: Option<u32>,
    pub relaxed_n: f64,
}

/// A stretch in which the reflex moves the fingers, frames, and the way.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    from: u32,
    to: u32,
    closes: bool,
    before_n: f64,
    most_n: f64,
    least_n: f64,
}

impl Stretch {
    fn of_sensor(&self) -> f64 {
        if self.closes { self.most_n - self.before_n } else { self.before_n - self.least_n }
    }
}

#[derive(Clone, Debug, Default)]
pub struct Added {
    load_n: Option<f64>,
    open: Option<Stretch>,
    stretches: Vec<Stretch>,
}

impl Recorder for Added {
    fn slow(&mut self, slow: &Slow) {
        let load_n = slow.forces.map(|forces| f64::from(forces.load_mn) / 1e3);
        for (frame, tick) in ticks(slow) {
            let closes = match tick.drive {
                _ if tick.source != DriveSource::Reflex => continue,
                MotorDrive::Close(_) => true,
                MotorDrive::Open(_) => false,
                MotorDrive::Coast => continue,
            };
            match &mut self.open {
                Some(open) if open.closes == closes => open.to = frame,
                open => {
                    self.stretches.extend(open.take());
                    let before_n = self.load_n.or(load_n).unwrap_or(0.0);
                    let own = Stretch {
                        from: frame,
                        to: frame,
                        closes,
                        before_n,
                        most_n: before_n,
                        least_n: before_n,
                    };
                    *open = Some(own);
                }
            }
        }
        self.load_n = load_n.or(self.load_n);
        if let Some(open) = &mut self.open {
            let load_n = self.load_n.unwrap_or(0.0);
            (open.most_n, open.least_n) = (open.most_n.max(load_n), open.least_n.min(load_n));
            if slow.wearer_active || slow.frame > open.to + SETTLED_FRAMES {
                self.stretches.extend(self.open.take());
            }
        }
    }
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grips(Vec<[f32; 2]>);

impl Grips {
    pub fn push(&mut self, row: &Row) {
        self.0.push([row.grip_n as f32, row.needed_n as f32]);
    }

    fn row(t_s: f64) -> usize {
        (t_s * f64::from(TRACE_HZ)) as usize
    }

    fn rows(&self, stretch: &Stretch) -> (usize, &[[f32; 2]]) {
        let (from, to) =
            (Self::row(frame_end_s(stretch.from)), Self::row(frame_end_s(stretch.to + SETTLED_FRAMES)));
        (from, self.0.get(from..self.0.len().min(to + 1)).unwrap_or_default())
    }

    fn gained(&self, stretch: &Stretch, truth: &Fate) -> [f64; 2] {
        let (from, rows) = self.rows(stretch);
        let mut most_n = rows.first().map_or(0.0, |[grip_n, _]| *grip_n);
        let (mut gained_n, mut without_n) = (0.0, 0.0);
        for (n, &[grip_n, _]) in rows.iter().enumerate().filter(|(_, [grip_n, _])| *grip_n > 0.0) {
            let gain_n = (grip_n - most_n).max(0.0);
            if gain_n == 0.0 {
                continue;
            }
            gained_n += f64::from(gain_n);
            let t_s = (from + n + 1) as f64 / f64::from(TRACE_HZ);
            if !slips(truth, t_s) {
                let needed_n = self.soon_needed_n(from + n) * ABOUT_PART;
                without_n += (f64::from(grip_n) - needed_n).clamp(0.0, f64::from(gain_n));
            }
            most_n = grip_n;
        }
        [gained_n, without_n]
    }

    fn lost(&self, stretch: &Stretch) -> f64 {
        let (_, rows) = self.rows(stretch);
        let least_n = rows.iter().map(|[grip_n, _]| *grip_n).fold(f32::INFINITY, f32::min);
        rows.first().map_or(0.0, |[grip_n, _]| f64::from(grip_n - least_n))
    }

    fn soon_needed_n(&self, from: usize) -> f64 {
        let rows = &self.0[from..self.0.len().min(from + Self::row(ABOUT_S))];
        f64::from(rows.iter().map(|[_, needed_n]| *needed_n).fold(0.0, f32::max))
    }
}

fn slips(truth: &Fate, t_s: f64) -> bool {
    truth.slips.iter().any(|slip| (slip.micro_onset_s - BEFORE_S..=slip.end_s + BEFORE_S).contains(&t_s))
}

impl Added {
    pub fn sums(&self, truth: Option<&Fate>) -> Sums {
        let (added_without_need_n, closings_without_need) = (truth.map(|_| 0.0), truth.map(|_| 0));
        let mut sums = Sums { added_without_need_n, closings_without_need, ..Sums::default() };
        for stretch in self.stretches.iter().chain(&self.open) {
            match truth {
                Some(truth) if stretch.closes => {
                    let [gained_n, without_n] = truth.grips.gained(stretch, truth);
                    sums.added_n += gained_n;
                    *sums.added_without_need_n.get_or_insert_default() += without_n;
                    *sums.closings_without_need.get_or_insert_default() += u32::from(without_n > NOTICED_N);
                }
                Some(truth) => sums.relaxed_n += truth.grips.lost(stretch),
                None if stretch.closes => sums.added_n += stretch.of_sensor(),
                None => sums.relaxed_n += stretch.of_sensor(),
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scorer::SlipSpan;

    /// A grip that a pulse of 0.1 s at 1 s lifts from 5 N to 8 N, under a need that is given.
    fn pulse(needed_n: impl Fn(f64) -> f32, slips: Vec<SlipSpan>) -> (Added, Fate) {
        let mut grips = Grips::default();
        for row in 0..3 * TRACE_HZ {
            // A row is of the instant at its end.
            let t_s = f64::from(row + 1) / f64::from(TRACE_HZ);
            grips.0.push([(5.0 + 30.0 * (t_s - 1.0).clamp(0.0, 0.1)) as f32, needed_n(t_s)]);
        }
        let stretch =
            Stretch { from: 1_980, to: 2_180, closes: true, before_n: 0.0, most_n: 0.0, least_n: 0.0 };
        (Added { stretches: vec![stretch], ..Added::default() }, Fate { grips, slips, ..Fate::default() })
    }

    fn sums(needed_n: impl Fn(f64) -> f32, slips: Vec<SlipSpan>) -> [f64; 2] {
        let (added, truth) = pulse(needed_n, slips);
        let sums = added.sums(Some(&truth));
        [sums.added_n, sums.added_without_need_n.unwrap()].map(|n| (n * 100.0).round() / 100.0)
    }

    #[test]
    fn what_is_added_counts_as_without_need_above_what_is_about_to_slip() {
        assert_eq!(sums(|_| 2.0, Vec::new()), [3.0, 3.0]);
        // About to slip up to 1.1 times 6 N; the rest was for nothing.
        assert_eq!(sums(|_| 6.0, Vec::new()), [3.0, 1.4]);
        // The need comes half a second later.
        assert_eq!(sums(|t_s| if t_s > 1.5 { 7.5 } else { 2.0 }, Vec::new()), [3.0, 0.0]);
        assert_eq!(sums(|t_s| if t_s > 2.5 { 7.5 } else { 2.0 }, Vec::new()), [3.0, 3.0]);
    }

    #[test]
    fn what_is_added_while_it_slips_is_needed() {
        let slip = SlipSpan {
            micro_onset_s: 0.99,
            macro_onset_s: Some(1.0),
            end_s: 1.06,
            distance_mm: 1.0,
            meant: false,
        };
        assert_eq!(sums(|_| 2.0, vec![slip]), [3.0, 0.0]);
        assert_eq!(sums(|_| 2.0, vec![SlipSpan { end_s: 1.0, ..slip }]), [3.0, 1.5]);
    }
}
