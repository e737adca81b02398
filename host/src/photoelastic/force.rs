//! How well the force is followed: ramps of up to 6 N/s that turn anywhere, the peak of the curve included.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_logic::photoelastic::Head;
use tenax_logic::photoelastic::track::{Hints, Track};
use tenax_logic::photoelastic::turn::Branch;
use tenax_scene::Seeds;
use tenax_scene::sensor::photoelastic::curve::{Day, Making, receiver_mv};
use tenax_scene::sensor::photoelastic::optics::Layer;

use super::balance;
use super::bench::{Bench, CYCLE_S, between, over_decades};

/// The fastest ramp, N/s.
const FASTEST_N_S: f64 = 6.0;
/// Noise of a scan at the pin, mV rms: 0.5 mV of a frame's mean.
const NOISE_MV: f64 = 1.0;
/// Nearer to the peak than this, N, either branch gives nearly the same force.
const AT_THE_PEAK_N: f64 = 0.06;

/// One cycle of a run.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// When, s.
    pub t_s: f64,
    /// The true force, N.
    pub true_n: f64,
    /// What was read, None while nothing is known.
    pub read_n: Option<f64>,
    /// How far off it may be, N.
    pub uncertainty_n: f64,
    /// Whether the branch is known.
    pub is_certain: bool,
    /// Whether it is the wrong one.
    pub is_wrong: bool,
}

/// A force over time: from one target to the next, evenly.
#[derive(Clone, Debug, Default)]
pub struct Story {
    /// Targets, N, and how fast each is approached, N/s.
    pub steps: Vec<(f64, f64)>,
}

impl Story {
    /// Ramps up and down in turn, each as fast as drawn. One in three turns near the peak, and half of those right at it.
    pub fn drawn(random: &mut ChaCha8Rng, peak_n: f64, end_n: f64) -> Self {
        let (mut steps, mut at_n) = (Vec::new(), 0.0);
        for n in 0..6 {
            let (low_n, high_n) = if n % 2 == 0 { (at_n, end_n) } else { (0.0, at_n) };
            let near_n = peak_n + between(random, -0.3, 0.3) * f64::from(random.random_range(0..2_u8));
            let target_n = if n == 5 {
                0.0
            } else if random.random_range(0..3_u8) == 0 && (low_n..high_n).contains(&near_n) {
                near_n
            } else {
                between(random, low_n, high_n)
            };
            steps.push((target_n, over_decades(random, 0.3, FASTEST_N_S)));
            at_n = target_n;
        }
        Self { steps }
    }

    /// The force of each cycle, from none back to none.
    fn forces(&self) -> Vec<f64> {
        let (mut forces, mut at_n) = (Vec::new(), 0.0_f64);
        for (target_n, speed_n_s) in &self.steps {
            let step_n = speed_n_s * CYCLE_S;
            while (target_n - at_n).abs() > step_n {
                at_n += step_n.copysign(target_n - at_n);
                forces.push(at_n);
            }
            at_n = *target_n;
            forces.push(at_n);
        }
        forces
    }
}

/// A head that was calibrated on its first day, on another day.
#[derive(Debug)]
pub struct Session {
    making: Making,
    day: Day,
    /// Where its light is brightest today, N: frozen birefringence moves it.
    peak_n: f64,
    /// Where it is back at its first value, N.
    end_n: f64,
    bench: Bench,
    noise: ChaCha8Rng,
}

impl Session {
    /// Of a head and a day drawn with this seed. A hand has gripped once over the peak with it since it was switched on.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let seeds = Seeds { making: seed, noise: seed };
        let making = Making::drawn(seeds, 0.2);
        let day = Day::drawn(Seeds { making: seed, noise: seed ^ 0xDA1 }, 0.02, 20.0);
        let calibrated = balance::weigh(&making, &Day::FIRST, seeds);
        let noise = ChaCha8Rng::seed_from_u64(seed);
        let bench = Bench::new(calibrated.config(), seed);
        let mv = |force_n: f64| receiver_mv(&Layer::DUBEY, &making, &day, 0.0, force_n, 0.0);
        let millinewtons = (1..3_000).map(|mn| f64::from(mn) / 1e3);
        let peak_n = millinewtons.max_by(|a, b| mv(*a).total_cmp(&mv(*b))).unwrap_or(making.peak_n);
        let mut millinewtons = (3_000..9_000).map(|mn| f64::from(mn) / 1e3);
        let end_n = millinewtons.find(|n| mv(*n) <= mv(0.0) + 0.1).unwrap_or(making.back_n);
        let mut session = Self { making, day, peak_n, end_n, bench, noise };
        session.rest();
        // A hand's first grip: its motor closes and opens.
        let (steps, mut at_n) = (200, 0.0);
        for n in 1..=2 * steps {
            let part = f64::from(n.min(2 * steps - n)) / f64::from(steps);
            let to_n = 0.8 * end_n * part;
            let drive = if n <= steps { 1 } else { -1 };
            session.cycle(at_n, to_n, Hints { drive, ..Hints::default() });
            at_n = to_n;
        }
        session.rest();
        session
    }

    /// The head.
    #[must_use]
    pub const fn making(&self) -> &Making {
        &self.making
    }

    /// Where its light is brightest today, N.
    #[must_use]
    pub const fn peak_n(&self) -> f64 {
        self.peak_n
    }

    /// The logic that reads it.
    #[must_use]
    pub const fn head(&self) -> &Head {
        &self.bench.head
    }

    /// Its day.
    #[must_use]
    pub const fn day(&self) -> &Day {
        &self.day
    }

    /// A second in an open hand.
    pub fn rest(&mut self) {
        for _ in 0..80 {
            self.cycle(0.0, 0.0, Hints { unloaded: true, ..Hints::default() });
        }
    }

    /// Runs a story without any hint.
    pub fn run(&mut self, story: &Story) -> Vec<Point> {
        let mut last_n = 0.0;
        let forces = story.forces();
        forces
            .into_iter()
            .map(|to_n| self.cycle(std::mem::replace(&mut last_n, to_n), to_n, Hints::default()))
            .collect()
    }

    /// One cycle in which the force goes evenly.
    pub fn cycle(&mut self, from_n: f64, to_n: f64, hints: Hints) -> Point {
        let (making, day, noise) = (&self.making, &self.day, &mut self.noise);
        let begin_s = self.bench.now_s();
        self.bench.cycle(hints, |t_s| {
            let force_n = from_n + (to_n - from_n) * (t_s - begin_s) / CYCLE_S;
            let draw = (0..12).map(|_| noise.random::<f64>()).sum::<f64>() - 6.0;
            (receiver_mv(&Layer::DUBEY, making, day, t_s, force_n, 0.0) + NOISE_MV * draw) / 1e3
        });
        let head = &self.bench.head;
        let (branch, is_certain) = match head.track() {
            Track::Certain(branch) => (Some(branch), true),
            Track::Likely(branch) => (Some(branch), false),
            Track::Saturated => (Some(Branch::Falling), false),
            Track::Unknown(_) => (None, false),
        };
        let truth = if to_n > self.peak_n { Branch::Falling } else { Branch::Rising };
        let force = head.force();
        Point {
            t_s: self.bench.now_s(),
            true_n: to_n,
            read_n: force.map(|force| f64::from(force.mn) / 1e3),
            uncertainty_n: force.map_or(f64::INFINITY, |force| f64::from(force.uncertainty_mn) / 1e3),
            is_certain,
            is_wrong: branch.is_some_and(|branch| branch != truth)
                && (to_n - self.peak_n).abs() > AT_THE_PEAK_N,
        }
    }
}

/// What many runs come to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Score {
    /// Root mean square of the error on the right branch, % of 6 N.
    pub rms_pct_fs: f64,
    /// The largest, %.
    pub max_pct_fs: f64,
    /// Time on the wrong branch, s.
    pub wrong_branch_s: f64,
    /// The longest at a stretch, s.
    pub longest_s: f64,
    /// All time, s.
    pub total_s: f64,
    /// Part of the time in which the branch was known.
    pub certain: f64,
    /// Cycles in which the branch was said to be known and the force was off by more than the uncertainty.
    pub certain_and_off: usize,
    /// Part of the time in which the true force was within the uncertainty.
    pub covered: f64,
}

/// Full scale, N.
const FULL_SCALE_N: f64 = 6.0;

impl Score {
    /// Of runs.
    #[must_use]
    pub fn of<'a>(runs: impl IntoIterator<Item = &'a [Point]>) -> Self {
        let (mut score, mut square, mut count, mut right) = (Self::default(), 0.0, 0.0, 0.0_f64);
        for run in runs {
            let mut wrong_s = 0.0;
            for point in run {
                count += 1.0;
                let error_n = point.read_n.map_or(FULL_SCALE_N, |read_n| read_n - point.true_n);
                score.covered += f64::from(u8::from(error_n.abs() <= point.uncertainty_n));
                score.certain_and_off += usize::from(point.is_certain && error_n.abs() > point.uncertainty_n);
                score.certain += f64::from(u8::from(point.is_certain));
                if point.is_wrong {
                    wrong_s += CYCLE_S;
                    score.wrong_branch_s += CYCLE_S;
                    score.longest_s = score.longest_s.max(wrong_s);
                    continue;
                }
                wrong_s = 0.0;
                let percent = error_n.abs() / FULL_SCALE_N * 100.0;
                right += 1.0;
                square += percent * percent;
                score.max_pct_fs = score.max_pct_fs.max(percent);
            }
        }
        score.rms_pct_fs = (square / right.max(1.0)).sqrt();
        score.total_s = count * CYCLE_S;
        score.certain /= count.max(1.0);
        score.covered /= count.max(1.0);
        score
    }
}

/// As many sessions as there are seeds, each with as many stories.
#[must_use]
pub fn sessions(seeds: impl IntoIterator<Item = u64>, stories: usize) -> Vec<Vec<Point>> {
    let mut runs = Vec::new();
    for seed in seeds {
        let mut session = Session::new(seed);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        for _ in 0..stories {
            let story = Story::drawn(&mut random, session.peak_n, session.end_n);
            runs.push(session.run(&story));
            session.rest();
        }
    }
    runs
}
