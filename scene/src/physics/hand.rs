//! The wearer's arm, which carries the hand up, down, and swinging.

use crate::file::sections::{Move, Swing};
use crate::schedule::LowPass;
use crate::schedule::{STEP_S, Span};

/// Time constant with which a person notices that the table carries, s (assumed).
const FEEL_S: f64 = 0.030;

/// The hand's height over where it grasps, and how it moves. The arm is strong: what the hand holds does not move it.
#[derive(Clone, Debug)]
pub struct Hand {
    moves: Vec<(Span, f64)>,
    swings: Vec<(Span, Swing)>,
    felt: LowPass,
    aim_m: f64,
    /// Over where it grasps; speed and acceleration are upwards.
    pub(crate) height_m: f64,
    pub(crate) speed_m_s: f64,
    pub(crate) acceleration_m_s2: f64,
}

impl Hand {
    pub(crate) fn new(moves: &[Move], swings: &[Swing]) -> Self {
        let mut from_m = 0.0;
        let moves = moves.iter().map(|step| {
            let by_m = step.to_mm.get() / 1e3 - from_m;
            from_m += by_m;
            (Span::of(step.at_s, step.for_s), by_m)
        });
        let moves = moves.collect();
        let swings = swings.iter().map(|swing| {
            let for_s = f64::from(swing.cycles.get()) / swing.rate_hz.get();
            (Span::new(swing.at_s.get(), for_s), swing.clone())
        });
        Self {
            moves,
            swings: swings.collect(),
            felt: LowPass::with_tau_s(FEEL_S),
            aim_m: 0.0,
            height_m: 0.0,
            speed_m_s: 0.0,
            acceleration_m_s2: 0.0,
        }
    }

    pub(crate) fn reach(&mut self, at_s: f64, for_s: f64, to_m: f64) {
        let from_m: f64 = self.moves.iter().map(|(_, by_m)| by_m).sum();
        self.moves.push((Span::new(at_s, for_s), to_m - from_m));
    }

    /// Goes on by one scan to `t_s`. `table_part` is the part of the object's weight that stands on the table: a person
    /// who puts something down slows as they feel it touch, and does not push it through the table.
    pub fn step(&mut self, t_s: f64, table_part: f64) {
        let felt_part = self.felt.step(table_part);
        let aim_m =
            self.moves.iter().map(|(span, by_m)| by_m * minimum_jerk(span.progress(t_s))).sum::<f64>();
        let aimed_m_s = (aim_m - self.aim_m) / STEP_S;
        self.aim_m = aim_m;
        let felt_m_s =
            if aimed_m_s < 0.0 { aimed_m_s * (1.0 - felt_part).clamp(0.0, 1.0) } else { aimed_m_s };
        let speed_m_s =
            felt_m_s + self.swings.iter().map(|(span, swing)| swing_m_s(span, swing, t_s)).sum::<f64>();
        self.acceleration_m_s2 = (speed_m_s - self.speed_m_s) / STEP_S;
        self.speed_m_s = speed_m_s;
        self.height_m += speed_m_s * STEP_S;
    }
}

/// Minimum jerk, as a person reaches: 10 p^3 - 15 p^4 + 6 p^5 (Flash and Hogan 1985).
fn minimum_jerk(p: f64) -> f64 {
    p * p * p * (10.0 + p * (6.0 * p - 15.0))
}

fn swing_m_s(span: &Span, swing: &Swing, t_s: f64) -> f64 {
    if !span.contains(t_s) {
        return 0.0;
    }
    let omega = std::f64::consts::TAU * swing.rate_hz.get();
    let window = (1.0 - libm::cos(std::f64::consts::TAU * span.progress(t_s))) / 2.0;
    swing.peak_m_s2.get() / omega * window * libm::sin(omega * (t_s - span.begin_s))
}
