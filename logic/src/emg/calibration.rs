//! Guided calibration: the wearer rests, closes and opens, five seconds each.

use tenax_hal_shim::channel::FRAME_HZ;

pub use tenax_hal_shim::words::Prompt;

use super::level::{TOP_LEVEL, level_of};
use super::model::{EmgModel, LEAST_SEPARATION_PERMILLE, Point, Refusal, octaves};
use super::trust::TOP_UV;

const PROMPTS: [Prompt; 3] = [Prompt::Rest, Prompt::Close, Prompt::Open];
pub const PROMPT_FRAMES: u32 = 5 * FRAME_HZ;
const REACTION_FRAMES: u32 = 7 * FRAME_HZ / 10;
/// Short calibration: rest, and the whole; contractions, closing first; readings of one above rest, of its begin that
/// does not count, and of the rest that ends it: 0.5 s, 0.2 s, 0.1 s.
const SHORT_REST_FRAMES: u32 = 2 * FRAME_HZ;
const WHOLE_FRAMES: u32 = 3 * PROMPT_FRAMES;
const TURNS: u32 = 6;
const TURN_READINGS: u32 = 120;
const BEGIN_READINGS: u32 = 48;
const QUIET_READINGS: u32 = 24;
const MISSING_PERMILLE: u32 = 50;
const TOP_PERMILLE: u32 = 100;
const HELD_PERMILLE: u32 = 600;
const STANDS_OUT: i32 = octaves(500);
/// Standard deviation below which an envelope is no muscle's, 1 %.
const STILL: i32 = octaves(15);
/// Range of an electrode that stuck through a step: 32 %. The other contraction's electrode of recorded people has 52 % at least.
const STUCK: i32 = octaves(400);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    Asks(Prompt, u32),
    Done(Result<EmgModel, Refusal>),
}

#[derive(Clone, Copy, Debug, Default)]
struct Phase {
    readings: u32,
    missing: u32,
    top: u32,
    summed: u32,
    sum: Point,
    squares: [i64; 2],
    squares_of_difference: i64,
    /// Highest level, and largest distance below the top, of the whole step.
    high: Point,
    depth: Point,
}

impl Phase {
    fn range(&mut self, uv: [Option<i32>; 2]) {
        for (n, level) in uv.into_iter().enumerate().filter_map(|(n, uv)| Some((n & 1, level_of(uv?)))) {
            self.high[n] = self.high[n].max(level);
            self.depth[n] = self.depth[n].max(TOP_LEVEL - level);
        }
    }

    /// Above rest throughout, and within a narrow range.
    fn has_stuck(&self, n: usize, rest: Point) -> bool {
        self.mean()[n] - rest[n] >= STANDS_OUT && self.high[n] + self.depth[n] - TOP_LEVEL <= STUCK
    }

    fn take(&mut self, uv: [Option<i32>; 2], stands_out: impl Fn(Point) -> bool) {
        self.readings += 1;
        let [Some(flexor), Some(extensor)] = uv else {
            self.missing += 1;
            return;
        };
        self.top += u32::from(flexor >= TOP_UV || extensor >= TOP_UV);
        let point = [level_of(flexor), level_of(extensor)];
        if !stands_out(point) {
            return;
        }
        self.summed += 1;
        for (n, &level) in point.iter().enumerate() {
            self.sum[n] += level;
            self.squares[n] += i64::from(level) * i64::from(level);
        }
        let difference = i64::from(point[1] - point[0]);
        self.squares_of_difference += difference * difference;
    }

    fn mean(&self) -> Point {
        // Not an `i32`: core's division by one panics for -1.
        let count = i64::from(self.summed.max(1));
        self.sum.map(|sum| (i64::from(sum) / count) as i32)
    }

    /// Q20.
    fn variance(&self, n: usize) -> i64 {
        variance(self.squares[n], i64::from(self.sum[n]), self.summed)
    }

    fn variance_of_difference(&self) -> i64 {
        variance(self.squares_of_difference, i64::from(self.sum[1] - self.sum[0]), self.summed)
    }

    fn has(&self, part: u32, permille: u32) -> bool {
        part * 1_000 > self.readings * permille
    }

    fn check(&self) -> Result<(), Refusal> {
        if self.readings == 0 || self.has(self.missing, MISSING_PERMILLE) {
            Err(Refusal::SensorLost)
        } else if self.has(self.top, TOP_PERMILLE) {
            Err(Refusal::Saturated)
        } else {
            Ok(())
        }
    }
}

fn variance(squares: i64, sum: i64, count: u32) -> i64 {
    let count = i64::from(count.max(1));
    (squares / count - sum * sum / (count * count)).max(0)
}

fn root(square: i64) -> i32 {
    square.max(0).unsigned_abs().isqrt() as i32
}

/// Distance over the common standard deviation of both ends, per mille.
fn separation(distance: i32, variances: [i64; 2]) -> i32 {
    let deviation = root((variances[0] + variances[1]) / 2).max(1);
    ((i64::from(distance.abs()) * 1_000) / i64::from(deviation)).min(1_000_000) as i32
}

/// Contractions in turn, each as long as the wearer makes it.
#[derive(Clone, Copy, Debug, Default)]
struct Turns {
    closing_site: usize,
    turn: u32,
    held: u32,
    quiet: u32,
}

impl Turns {
    /// True if the reading counts.
    fn take(&mut self, stands_out: bool) -> bool {
        self.quiet = if stands_out { 0 } else { self.quiet + 1 };
        self.held += u32::from(stands_out);
        if self.held >= TURN_READINGS && self.quiet >= QUIET_READINGS {
            (self.turn, self.held) = (self.turn + 1, 0);
        }
        self.held > BEGIN_READINGS
    }
}

#[derive(Clone, Debug)]
pub struct Calibration {
    began: u32,
    /// Of a short calibration.
    turns: Option<Turns>,
    phases: [Phase; 3],
    /// Steps that were asked for again, and the one of them that is under way.
    again: [bool; 3],
    last: usize,
    over: Option<Result<EmgModel, Refusal>>,
}

impl Calibration {
    pub fn begin(frame: u32) -> Self {
        Self {
            began: frame,
            turns: None,
            phases: [Phase::default(); 3],
            again: [false; 3],
            last: 2,
            over: None,
        }
    }

    /// Three closings and openings in turn, for a wearer whose electrodes have moved, not exchanged.
    pub fn short(frame: u32, kept: &EmgModel) -> Self {
        let turns = Turns { closing_site: kept.closing_site(), ..Turns::default() };
        Self { turns: Some(turns), ..Self::begin(frame) }
    }

    /// Envelopes above the live zero, uV, flexor first; None: no number. Once for each pair of readings.
    pub fn take(&mut self, frame: u32, uv: [Option<i32>; 2]) -> Progress {
        if let Some(result) = self.over {
            return Progress::Done(result);
        }
        let since = frame.wrapping_sub(self.began);
        if self.is_over(frame) {
            return self.end(frame);
        }
        let (phase, within, left) = match &self.turns {
            None => {
                let (step, within) = ((since / PROMPT_FRAMES) as usize, since % PROMPT_FRAMES);
                (if step < 2 { step } else { self.last.min(2) }, within, PROMPT_FRAMES - within)
            }
            Some(_) if since < SHORT_REST_FRAMES => (0, since, SHORT_REST_FRAMES - since),
            Some(turns) => (1 + turns.turn as usize % 2, since, WHOLE_FRAMES - since),
        };
        self.phases[phase].range(uv);
        if within >= REACTION_FRAMES {
            let rest = self.phases[0].mean();
            let stands_out =
                |point: Point| point[0] - rest[0] >= STANDS_OUT || point[1] - rest[1] >= STANDS_OUT;
            let counts = match (&mut self.turns, uv) {
                (Some(turns), [Some(flexor), Some(extensor)]) if phase > 0 => {
                    turns.take(stands_out([level_of(flexor), level_of(extensor)]))
                }
                _ => true,
            };
            self.phases[phase].take(uv, |point| phase == 0 || counts && stands_out(point));
        }
        Progress::Asks(PROMPTS[phase], left)
    }

    fn end(&mut self, frame: u32) -> Progress {
        let result = match self.stuck() {
            Some(step) if !self.again[step] && self.turns.is_none() => {
                (self.phases[step], self.again[step], self.last) = (Phase::default(), true, step);
                self.began = frame.wrapping_sub(2 * PROMPT_FRAMES);
                return Progress::Asks(PROMPTS[step], PROMPT_FRAMES);
            }
            Some(_) => Err(Refusal::NotAMuscle),
            None => self.conclude(),
        };
        self.over = Some(result);
        Progress::Done(result)
    }

    /// The contraction during which the other contraction's electrode stuck.
    fn stuck(&self) -> Option<usize> {
        let [rest, close, open] = self.phases.map(|phase| phase.mean());
        let model = EmgModel::new(rest, close, open, [0; 2], LEAST_SEPARATION_PERMILLE).ok()?;
        let others = [(1, model.opening_site()), (2, model.closing_site())];
        let step = others.into_iter().find(|&(step, other)| self.phases[step].has_stuck(other, rest));
        step.map(|(step, _)| step)
    }

    pub fn is_over(&self, frame: u32) -> bool {
        let has_turned = self.turns.is_some_and(|turns| turns.turn >= TURNS);
        has_turned || frame.wrapping_sub(self.began) >= WHOLE_FRAMES
    }

    fn conclude(&self) -> Result<EmgModel, Refusal> {
        let [rest, close, open] = &self.phases;
        for phase in &self.phases {
            phase.check()?;
        }
        let is_held = |phase: &Phase, turn: u32| match self.turns {
            Some(turns) => turns.turn >= turn,
            None => phase.has(phase.summed, HELD_PERMILLE),
        };
        if !is_held(close, TURNS - 1) {
            return Err(Refusal::NoClosing);
        }
        if !is_held(open, TURNS) {
            return Err(Refusal::NoOpening);
        }
        let spread = [root(rest.variance(0)), root(rest.variance(1))];
        // First a reason for what is no model at all, then the separation.
        let model = EmgModel::new(rest.mean(), close.mean(), open.mean(), spread, LEAST_SEPARATION_PERMILLE)?;
        let (closes, opens) = (model.closing_site(), model.opening_site());
        if self.turns.is_some_and(|turns| turns.closing_site != closes) {
            return Err(Refusal::SameDirection);
        }
        if root(close.variance(closes)) < STILL || root(open.variance(opens)) < STILL {
            return Err(Refusal::NotAMuscle);
        }
        let from_rest = |phase: &Phase, n: usize| {
            separation(phase.mean()[n] - rest.mean()[n], [phase.variance(n), rest.variance(n)])
        };
        let difference = |phase: &Phase| phase.mean()[1] - phase.mean()[0];
        let turn = separation(
            difference(open) - difference(close),
            [open.variance_of_difference(), close.variance_of_difference()],
        );
        let least = from_rest(close, closes).min(from_rest(open, opens)).min(turn);
        EmgModel::new(rest.mean(), close.mean(), open.mean(), spread, least)?
            .with_close_spread(root(close.variance_of_difference()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec;
    use std::vec::Vec;

    fn run(envelopes: impl Fn(u32, u32) -> [f64; 2]) -> Result<EmgModel, Refusal> {
        asked(envelopes).1
    }

    fn asked(envelopes: impl Fn(u32, u32) -> [f64; 2]) -> (Vec<Prompt>, Result<EmgModel, Refusal>) {
        let mut calibration = Calibration::begin(u32::MAX - 100);
        let mut prompts = vec![];
        for n in 0.. {
            let frame = (u32::MAX - 100).wrapping_add(n * 25 / 3);
            let step = n * 25 / 3 / PROMPT_FRAMES;
            let phase = if step < 3 { step } else { prompts.last().map_or(0, |&prompt| prompt as u32) };
            let uv = envelopes(phase, n).map(|mv| (mv >= 0.0).then_some((mv * 1e3) as i32));
            match calibration.take(frame, uv) {
                Progress::Done(result) => return (prompts, result),
                Progress::Asks(prompt, left) => {
                    if step >= prompts.len() as u32 {
                        prompts.push(prompt);
                    }
                    assert!((1..=PROMPT_FRAMES).contains(&left));
                }
            }
        }
        unreachable!("it ends by itself")
    }

    fn lively(n: u32, k: u32, part: f64) -> f64 {
        1.0 + part * 1.41 * (f64::from(n) * (0.11 + 0.027 * f64::from(k))).sin()
    }

    fn states(phase: u32, n: u32, mv: [[f64; 2]; 3]) -> [f64; 2] {
        [0, 1].map(|k| mv[phase as usize][k] * lively(n, k as u32, if phase == 0 { 0.05 } else { 0.15 }))
    }

    const GOOD: [[f64; 2]; 3] = [[60.0, 50.0], [450.0, 165.0], [150.0, 1_400.0]];

    #[test]
    fn it_learns_where_the_three_states_lie() {
        let model = run(|phase, n| states(phase, n, GOOD)).unwrap();
        for (point, mv) in [model.rest(), model.close(), model.open()].iter().zip(GOOD) {
            for n in 0..2 {
                assert!((point[n] - level_of((mv[n] * 1e3) as i32)).abs() < 40, "{point:?} {mv:?}");
            }
        }
        assert!(model.separation_permille() > 8_000, "{}", model.separation_permille());
    }

    #[test]
    fn a_wearer_who_reacts_late_is_still_learned() {
        let late = |phase: u32, n: u32| {
            let within = (n * 25 / 3) % PROMPT_FRAMES;
            states(if within < FRAME_HZ * 3 / 2 && phase > 0 { 0 } else { phase }, n, GOOD)
        };
        let model = run(late).unwrap();
        assert!((model.open()[1] - level_of(1_400_000)).abs() < 50);
    }

    #[test]
    fn a_calibration_without_a_reading_learns_nothing_and_its_verdict_stands() {
        let mut calibration = Calibration::begin(0);
        let over = Progress::Done(Err(Refusal::SensorLost));
        assert_eq!(calibration.take(3 * PROMPT_FRAMES, [Some(60_000); 2]), over);
        assert_eq!(calibration.take(PROMPT_FRAMES - 1, [Some(60_000); 2]), over, "whatever comes later");
    }

    // Shows W7.
    #[test]
    fn a_step_in_which_the_other_electrode_stuck_is_asked_for_again_and_refused_then() {
        use Prompt::{Close, Open, Rest};
        let sticks = |until: u32, step: u32, other: usize, share: f64| {
            move |phase: u32, n: u32| {
                let mut mv = states(phase, n, GOOD);
                let own = GOOD[3 - step as usize][other];
                if phase == step && n * 25 / 3 < until * PROMPT_FRAMES {
                    mv[other] = share * own * (1.0 + 0.1 * (f64::from(n) * 0.02).sin());
                }
                mv
            }
        };
        for share in [0.3, 0.6, 1.0] {
            let (prompts, result) = asked(sticks(3, 2, 0, share));
            assert_eq!((prompts, result.is_ok()), (vec![Rest, Close, Open, Open], true), "{share}");
            let (prompts, result) = asked(sticks(9, 2, 0, share));
            assert_eq!(
                (prompts, result),
                (vec![Rest, Close, Open, Open], Err(Refusal::NotAMuscle)),
                "{share}"
            );
        }
        let (prompts, result) = asked(sticks(2, 1, 1, 0.3));
        assert_eq!((prompts, result.is_ok()), (vec![Rest, Close, Open, Close], true));
        let (prompts, result) = asked(|phase, n| states(phase, n, GOOD));
        assert_eq!((prompts, result.is_ok()), (vec![Rest, Close, Open], true));
    }

    // Shows W7.
    #[test]
    fn three_closings_and_openings_in_turn_are_a_calibration_that_exchanges_nothing() {
        const MOVED: [[f64; 2]; 3] = [[80.0, 60.0], [600.0, 250.0], [300.0, 900.0]];
        let kept = run(|phase, n| states(phase, n, GOOD)).unwrap();
        let don = |order: [u32; 2], turns: u32, mv: [[f64; 2]; 3]| {
            let mut calibration = Calibration::short(7, &kept);
            for n in 0u32.. {
                // 2 s of rest, then 1.2 s of each contraction and 0.6 s of rest.
                let turn = n.saturating_sub(480) / 432;
                let rests = n < 480 || n % 432 < 144 || turn >= turns;
                let phase = if rests { 0 } else { order[turn as usize % 2] };
                let uv = states(phase, n, mv).map(|mv| Some((mv * 1e3) as i32));
                if let Progress::Done(result) = calibration.take(7 + n * 25 / 3, uv) {
                    return (n / 240, result);
                }
            }
            unreachable!("it ends by itself")
        };
        let (seconds, model) = don([1, 2], 6, MOVED);
        let model = model.unwrap();
        assert!(seconds < 14, "{seconds}");
        for (point, mv) in [model.rest(), model.close(), model.open()].iter().zip(MOVED) {
            for n in 0..2 {
                assert!((point[n] - level_of((mv[n] * 1e3) as i32)).abs() < 60, "{point:?} {mv:?}");
            }
        }
        assert_eq!(don([2, 1], 6, MOVED).1, Err(Refusal::SameDirection));
        assert_eq!(don([1, 2], 6, MOVED.map(|[a, b]| [b, a])).1, Err(Refusal::SameDirection));
        assert_eq!(don([1, 2], 5, MOVED), (15, Err(Refusal::NoOpening)));
    }

    #[test]
    fn what_cannot_be_used_is_refused() {
        let with = |phase: usize, mv: [f64; 2]| {
            let mut all = GOOD;
            all[phase] = mv;
            all
        };
        for (mv, refusal) in [
            (with(1, GOOD[0]), Refusal::NoClosing),
            (with(2, GOOD[0]), Refusal::NoOpening),
            (with(2, GOOD[1]), Refusal::SameDirection),
            (with(2, [-1.0, 900.0]), Refusal::SensorLost),
            (with(2, [150.0, 2_940.0]), Refusal::Saturated),
            (with(1, [2_940.0, 165.0]), Refusal::Saturated),
        ] {
            assert_eq!(run(|phase, n| states(phase, n, mv)), Err(refusal));
        }
        let restless = |phase, n| {
            if phase == 0 { GOOD[0].map(|mv| mv * lively(n, 0, 0.5)) } else { states(phase, n, GOOD) }
        };
        assert_eq!(run(restless), Err(Refusal::RestNotQuiet));
        for (at, mv) in [(1, GOOD[1]), (2, [60.0, 600.0])] {
            let still = |phase, n| if phase == at { mv } else { states(phase, n, GOOD) };
            assert_eq!(run(still), Err(Refusal::NotAMuscle), "{at}");
        }
        let wild = |phase, n| {
            if phase == 0 {
                states(0, n, GOOD)
            } else {
                [0, 1].map(|k| GOOD[phase as usize][k] * lively(n, k as u32, 0.69))
            }
        };
        assert_eq!(run(wild), Err(Refusal::Overlap));
    }
}
