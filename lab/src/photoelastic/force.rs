//! Errors of the followed force: ramps of up to 6 N/s that turn anywhere, the peak of the curve included, without shear and with the
//! shear that a held object has.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_logic::photoelastic::track::{Branch, Hints, SHEAR_MAX_PERMILLE, Track};
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
    pub t_s: f64,
    pub true_n: f64,
    /// The reading, None while there is none.
    pub read_n: Option<f64>,
    /// Its uncertainty, N.
    pub uncertainty_n: f64,
    /// The least and the most that it can be, N: what stands in for a force sensor's normal force, and for its load.
    pub range_n: (f64, f64),
    /// The true shear, of the force.
    pub shear: f64,
    pub is_certain: bool,
    pub is_wrong: bool,
}

/// A force over time: from one target to the next, evenly.
#[derive(Clone, Debug, Default)]
pub struct Story {
    /// Targets, N, and how fast each is approached, N/s.
    pub steps: Vec<(f64, f64)>,
    /// The shear at each target, of the force there: it changes evenly on the way, and then for as long again while the force stays.
    /// None where nothing shears.
    pub shears: Vec<f64>,
}

/// Part of the way in which the shear changes with the force; the rest comes while the force stays, as in a lift.
const SHEARED_ON_THE_WAY: f64 = 0.5;
const LIFT_CYCLES: (f64, f64) = (8.0, 80.0);

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
        Self { steps, shears: Vec::new() }
    }

    pub fn sheared(mut self, random: &mut ChaCha8Rng) -> Self {
        let most = f64::from(SHEAR_MAX_PERMILLE) / 1e3;
        self.shears = self.steps.iter().map(|_| between(random, 0.0, most)).collect();
        self
    }

    /// The force and its shear, of the force, of each cycle, from none back to none.
    fn forces(&self) -> Vec<(f64, f64)> {
        let (mut forces, mut at_n, mut sheared) = (Vec::new(), 0.0_f64, 0.0_f64);
        for (n, (target_n, speed_n_s)) in self.steps.iter().enumerate() {
            let shear = self.shears.get(n).copied().unwrap_or(0.0);
            let ramp = ((target_n - at_n).abs() / (speed_n_s * CYCLE_S)).ceil().max(1.0) as usize;
            let between = |part: f64, from: f64, to: f64| from + part * (to - from);
            let on_the_way = between(SHEARED_ON_THE_WAY, sheared, shear);
            forces.extend((1..=ramp).map(|cycle| {
                let part = cycle as f64 / ramp as f64;
                (between(part, at_n, *target_n), between(part, sheared, on_the_way))
            }));
            if !self.shears.is_empty() {
                let lift = (ramp as f64).clamp(LIFT_CYCLES.0, LIFT_CYCLES.1) as usize;
                forces.extend(
                    (1..=lift)
                        .map(|cycle| (*target_n, between(cycle as f64 / lift as f64, on_the_way, shear))),
                );
            }
            (at_n, sheared) = (*target_n, shear);
        }
        forces
    }
}

/// A head that was calibrated on its first day, on another day.
#[derive(Debug)]
pub struct Session {
    making: Making,
    day: Day,
    /// Force of the brightest light today, N: frozen birefringence moves it.
    peak_n: f64,
    /// Force at which the light is back at its first value, N.
    end_n: f64,
    bench: Bench,
    noise: ChaCha8Rng,
}

impl Session {
    /// A head and a day drawn with this seed, after one grip over the peak.
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
            session.cycle((at_n, 0.0), (to_n, 0.0), Hints::default());
            at_n = to_n;
        }
        session.rest();
        session
    }

    /// A second in an open hand.
    pub fn rest(&mut self) {
        for _ in 0..80 {
            self.cycle((0.0, 0.0), (0.0, 0.0), Hints { unloaded: true, ..Hints::default() });
        }
    }

    /// Runs a story without any hint.
    pub fn run(&mut self, story: &Story) -> Vec<Point> {
        let mut last = (0.0, 0.0);
        let forces = story.forces();
        forces
            .into_iter()
            .map(|to| self.cycle(std::mem::replace(&mut last, to), to, Hints::default()))
            .collect()
    }

    /// One cycle in which the force and its shear, of the force, go evenly.
    pub fn cycle(
        &mut self,
        (from_n, from_shear): (f64, f64),
        (to_n, shear): (f64, f64),
        hints: Hints,
    ) -> Point {
        let (making, day, noise) = (&self.making, &self.day, &mut self.noise);
        let begin_s = self.bench.now_s();
        self.bench.cycle(hints, |t_s| {
            let part = (t_s - begin_s) / CYCLE_S;
            let force_n = from_n + (to_n - from_n) * part;
            let shear_n = force_n * (from_shear + (shear - from_shear) * part);
            let draw = (0..12).map(|_| noise.random::<f64>()).sum::<f64>() - 6.0;
            (receiver_mv(&Layer::DUBEY, making, day, t_s, force_n, shear_n) + NOISE_MV * draw) / 1e3
        });
        let head = &self.bench.head;
        let (branch, is_certain) = match head.track() {
            Track::Certain(branch) => (Some(branch), true),
            Track::Either | Track::Unknown => (None, false),
        };
        // Shear moves the fold to a smaller phase.
        let stretch = (1.0 + 4.0 * shear * shear).sqrt();
        let folded = making.phase_rad(to_n) * stretch > std::f64::consts::FRAC_PI_2;
        let truth = if folded { Branch::Falling } else { Branch::Rising };
        let force = head.force();
        Point {
            t_s: self.bench.now_s(),
            true_n: to_n,
            read_n: force.map(|force| f64::from(force.mn()) / 1e3),
            uncertainty_n: force.map_or(f64::INFINITY, |force| f64::from(force.uncertainty_mn()) / 1e3),
            range_n: head.stand_in().map_or((0.0, f64::INFINITY), |told| {
                (f64::from(told.fn_mn) / 1e3, f64::from(told.load_mn) / 1e3)
            }),
            shear,
            is_certain,
            is_wrong: branch.is_some_and(|branch| branch != truth)
                && (to_n - self.peak_n).abs() > AT_THE_PEAK_N,
        }
    }
}

const FULL_SCALE_N: f64 = 6.0;

#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Score {
    /// Root mean square of the error where the head says that it is certain, % of 6 N.
    pub rms_pct_fs: f64,
    /// The largest of them, %.
    pub max_pct_fs: f64,
    /// Part of the cycles in which the head says so.
    pub certain_part: f64,
    /// Part of those in which the force is off by more than the head says.
    pub certain_off_part: f64,
    /// Part of all cycles in which the load that stands in is below the true force: a ceiling would be met late.
    pub load_below_part: f64,
    /// Part of all cycles in which the least force is above the true one: the margin would be too large.
    pub least_above_part: f64,
    /// Time in which the head says that it is certain, and of the wrong branch, s.
    pub wrong_branch_s: f64,
    pub cycles: usize,
}

impl Score {
    pub fn of<'a>(runs: impl IntoIterator<Item = &'a [Point]>) -> Self {
        let (mut score, mut squares, mut certain, mut off) = (Self::default(), 0.0, 0_usize, 0_usize);
        let (mut below, mut above) = (0_usize, 0_usize);
        for point in runs.into_iter().flatten() {
            score.cycles += 1;
            below += usize::from(point.range_n.1 < point.true_n);
            above += usize::from(point.range_n.0 > point.true_n);
            score.wrong_branch_s += f64::from(u8::from(point.is_wrong)) * CYCLE_S;
            if point.is_certain {
                let error_n = point.read_n.map_or(FULL_SCALE_N, |read_n| (read_n - point.true_n).abs());
                let percent = 100.0 * error_n / FULL_SCALE_N;
                certain += 1;
                off += usize::from(error_n > point.uncertainty_n);
                squares += percent * percent;
                score.max_pct_fs = score.max_pct_fs.max(percent);
            }
        }
        let part = |of: usize, all: usize| of as f64 / all.max(1) as f64;
        score.rms_pct_fs = (squares / certain.max(1) as f64).sqrt();
        score.certain_part = part(certain, score.cycles);
        score.certain_off_part = part(off, certain);
        (score.load_below_part, score.least_above_part) =
            (part(below, score.cycles), part(above, score.cycles));
        score
    }
}

pub fn sessions(seeds: impl IntoIterator<Item = u64>, stories: usize, sheared: bool) -> Vec<Vec<Point>> {
    let mut runs = Vec::new();
    for seed in seeds {
        let mut session = Session::new(seed);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        for _ in 0..stories {
            let mut story = Story::drawn(&mut random, session.peak_n, session.end_n);
            if sheared {
                story = story.sheared(&mut random);
            }
            runs.push(session.run(&story));
            session.rest();
        }
    }
    runs
}
