//! L1: a patch of bristles under a Hertzian load. It begins to slide at its edge, long before all of it slides.

use std::num::NonZeroU16;

use super::friction::Friction;
use super::level;

/// Elements of the shipped patch. The worst error of the shear is `0.375 / N^2` of `mu P`: 0.07 %.
pub const ELEMENTS: NonZeroU16 = NonZeroU16::new(24).unwrap();

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pad {
    /// Radius a of the contact, m. It is kept under every load: a fingertip that is flattened already. Assumed.
    pub radius_m: f64,
    pub stiffness_n_per_m3: f64,
}

impl Pad {
    pub fn stiffness_n_per_m(&self) -> f64 {
        self.stiffness_n_per_m3 * self.area_m2()
    }

    pub fn macro_slip_m(&self, normal_n: f64, mu: f64) -> f64 {
        mu * 1.5 * normal_n / self.stiffness_n_per_m()
    }

    fn area_m2(&self) -> f64 {
        std::f64::consts::PI * self.radius_m * self.radius_m
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Element {
    area_part: f64,
    load_part: f64,
    stiffness_n_per_m: f64,
    bristle_m: f64,
    sticks: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outcome {
    pub shear_n: f64,
    pub let_go: usize,
    pub released_n: f64,
    pub stuck_part: f64,
}

/// A patch of rings whose pressures are evenly spaced.
///
/// With `w = p / p0 = sqrt(1 - (r/a)^2)` a ring between `w1` and `w2` has the area part `w2^2 - w1^2` and the load part
/// `w2^3 - w1^3`, both exact. Only the ring that the edge of the stick zone crosses is in error, of second order in 1/N, and the
/// rings let go at evenly spaced displacements.
#[derive(Clone, Debug, PartialEq)]
pub struct BrushPatch {
    pad: Pad,
    elements: Vec<Element>,
}

impl BrushPatch {
    pub fn new(pad: Pad, elements: NonZeroU16) -> Self {
        let edge = |n: u16| f64::from(n) / f64::from(elements.get());
        let ring = |n: u16| {
            let (low, high) = (edge(n), edge(n + 1));
            Element {
                area_part: high * high - low * low,
                load_part: high * high * high - low * low * low,
                stiffness_n_per_m: (high * high - low * low) * pad.stiffness_n_per_m(),
                bristle_m: 0.0,
                sticks: true,
            }
        };
        Self { pad, elements: (0..elements.get()).map(ring).collect() }
    }

    /// Goes on by a displacement of `by_m` of the object over the pad, pressed with `normal_n`.
    ///
    /// Each element holds until it carries `mu_s` of its load, drops to `mu_d` and slides there until the motion stops or
    /// turns. It is exact at any step in which the direction does not change.
    pub fn step(&mut self, normal_n: f64, friction: Friction, by_m: f64) -> Outcome {
        let normal_n = normal_n.max(0.0);
        let drop = friction.mu_s - friction.mu_d;
        let rests = by_m == 0.0;
        let mut outcome = Outcome::default();
        for element in &mut self.elements {
            // The deflection at which the friction coefficient is 1, m.
            let whole_m = element.load_part * normal_n / element.stiffness_n_per_m;
            let trial_m = element.bristle_m + by_m;
            let slides_m = friction.mu_d * whole_m;
            let slid = !element.sticks;
            element.sticks = if slid {
                trial_m.abs() < slides_m || rests
            } else {
                trial_m.abs() <= friction.mu_s * whole_m
            };
            if element.sticks {
                element.bristle_m = trial_m;
                outcome.stuck_part += element.area_part;
            } else {
                element.bristle_m = slides_m.copysign(trial_m);
                if !slid {
                    outcome.let_go += 1;
                    outcome.released_n += drop * element.load_part * normal_n;
                }
            }
            outcome.shear_n += element.stiffness_n_per_m * element.bristle_m;
        }
        outcome
    }

    pub fn is_sliding(&self) -> bool {
        self.elements.iter().all(|element| !element.sticks)
    }

    pub fn energy_j(&self) -> f64 {
        let squares =
            self.elements.iter().map(|element| element.area_part * element.bristle_m * element.bristle_m);
        0.5 * self.pad.stiffness_n_per_m() * squares.sum::<f64>()
    }
}

/// The skin of one pad: a [`BrushPatch`] whose bristles are damped as rubber is.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    brush: BrushPatch,
    stiffness_n_per_m: f64,
    /// Damping over stiffness of the rubber, s: only what sticks deforms, so only that is damped.
    relaxation_s: f64,
    shear_n: f64,
    stuck_part: f64,
}

impl Patch {
    pub fn new(pad: Pad, relaxation_s: f64) -> Self {
        Self {
            brush: BrushPatch::new(pad, ELEMENTS),
            stiffness_n_per_m: pad.stiffness_n_per_m(),
            relaxation_s,
            shear_n: 0.0,
            stuck_part: 1.0,
        }
    }

    pub fn energy_j(&self) -> f64 {
        self.brush.energy_j()
    }

    /// Moves a mass on `pads` like this one; see [`super::level::Level::step`].
    ///
    /// Backward Euler over what sticks: `m v = m v_free - dt (Q + K v dt + K tau v)`. Each term takes energy or moves it
    /// between mass and bristles, so none grows, at any step and stiffness. What slides pulls with the shear that it has;
    /// when the mass turns round, all of it sticks again and is a spring too.
    pub(super) fn step(&mut self, push: level::Push, dt_s: f64) -> level::Outcome {
        let level::Push { normal_n, pads, friction, mass_kg, free_m_s } = push;
        // The pad's last shear, limited by this step's load.
        let limit_n = friction.mu_s * normal_n;
        let pull_n = pads * self.shear_n.clamp(-limit_n, limit_n);
        let momentum_ns = mass_kg * free_m_s - pull_n * dt_s;
        let turns_round = momentum_ns * self.shear_n < 0.0;
        let springs_n_per_m = pads * self.stiffness_n_per_m * if turns_round { 1.0 } else { self.stuck_part };
        let speed_m_s = momentum_ns / (mass_kg + springs_n_per_m * dt_s * (dt_s + self.relaxation_s));

        let outcome = self.brush.step(normal_n, friction, speed_m_s * dt_s);
        self.shear_n = outcome.shear_n;
        self.stuck_part = outcome.stuck_part.min(1.0);
        level::Outcome {
            speed_m_s,
            force_n: mass_kg * (speed_m_s - free_m_s) / dt_s,
            sticks: self.stuck_part > 0.0,
            stuck_part: self.stuck_part,
            let_go: outcome.let_go,
            released_n: outcome.released_n,
        }
    }
}

/// The closed forms, for one friction coefficient, with `s = k delta / (mu p0)` from 0 to 1.
pub mod closed_form {
    pub fn shear(s: f64) -> f64 {
        (3.0 * s - s * s * s) / 2.0
    }

    pub fn shear_with_drop(s: f64, friction: super::Friction) -> f64 {
        1.5 * friction.mu_s * s * (1.0 - s * s) + friction.mu_d * s * s * s
    }

    /// The s of its greatest shear: `sqrt(mu_s / (3 mu_s - 2 mu_d))`. Whoever pulls harder than there loses all of it.
    pub fn peak(friction: super::Friction) -> f64 {
        (friction.mu_s / (3.0 * friction.mu_s - 2.0 * friction.mu_d)).sqrt()
    }
}
