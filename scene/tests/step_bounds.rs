//! Each bound of [`bounds`] is where it says: 0.9 of it is stable, 1.1 fails, and as fast as predicted.

use tenax_scene::bounds;
use tenax_scene::physics::friction::Friction;
use tenax_scene::stepping::problem::{Incline, Problem, ShakenHold, error, problems};
use tenax_scene::stepping::{
    Body, Bristle, ExplicitEuler, Exponential, Implicit, Load, LuGre, Method, Moreau, RungeKutta4, SHIPPED_S,
    State, methods, run,
};

const LUGRE: LuGre = LuGre::SHARP;
const LIMIT_N: f64 = 0.8;
const SLIDE_M_S: f64 = 0.04;

/// By how much a sliding bristle's deviation from even sliding is multiplied at each step.
fn bristle_factor(method: &dyn Method, dt_s: f64) -> f64 {
    let sliding_m = LIMIT_N / LUGRE.stiffness_n_per_m;
    let after_m = method.drag(Bristle { sliding_m }, 1.001 * sliding_m, SLIDE_M_S, dt_s);
    (after_m - sliding_m) / (0.001 * sliding_m)
}

#[test]
fn a_sliding_bristle_under_explicit_euler() {
    let bound_s = bounds::explicit_bristle_s(LIMIT_N, LUGRE.stiffness_n_per_m, SLIDE_M_S);
    assert!((bound_s - 40e-6).abs() < 1e-12);
    for (part, factor) in [(0.5, 0.0), (0.9, -0.8), (1.1, -1.2)] {
        let found = bristle_factor(&ExplicitEuler(LUGRE), part * bound_s);
        assert!((found - factor).abs() < 1e-9, "{part}: {found}");
    }
}

#[test]
fn a_sliding_bristle_under_rk4() {
    let bound_s = bounds::runge_kutta_bristle_s(LIMIT_N, LUGRE.stiffness_n_per_m, SLIDE_M_S);
    let at = |part: f64| bristle_factor(&RungeKutta4(LUGRE), part * bound_s);
    assert!(at(0.9).abs() < 1.0 && (at(1.0) - 1.0).abs() < 1e-6 && at(1.1) > 1.2);
}

#[test]
fn a_sliding_bristle_under_the_others_at_any_step() {
    let bound_s = bounds::explicit_bristle_s(LIMIT_N, LUGRE.stiffness_n_per_m, SLIDE_M_S);
    let others: [&dyn Method; 3] = [&Exponential(LUGRE), &Implicit(LUGRE), &Moreau];
    for method in others {
        for part in [0.9, 1.1, 1e3, 1e9] {
            let factor = bristle_factor(method, part * bound_s);
            assert!((0.0..1.0).contains(&factor), "{} at {part}: {factor}", method.name());
        }
    }
}

/// A mass on a spring; with the shear of a bristle that sticks, the bristle is the spring.
struct Oscillator {
    stiffness_n_per_m: f64,
    damping_ns_per_m: f64,
    normal_n: f64,
}

const MASS_KG: f64 = 0.2;

impl Body for Oscillator {
    fn mass_kg(&self) -> f64 {
        MASS_KG
    }

    fn friction(&self) -> Friction {
        Friction { mu_s: 0.5, mu_d: 0.5 }
    }

    fn start(&self) -> (f64, f64) {
        (0.0, 1e-9)
    }

    fn load(&self, _: f64, position_m: f64, speed_m_s: f64) -> Load {
        let force_n = -self.stiffness_n_per_m * position_m - self.damping_ns_per_m * speed_m_s;
        Load { force_n, normal_n: self.normal_n, surface_m_s: 0.0 }
    }
}

/// How far it swings in the last tenth of 2000 steps, over the first.
fn swing(method: &dyn Method, body: &Oscillator, dt_s: f64) -> f64 {
    let (mut first_m, mut last_m, mut n) = (0.0_f64, 0.0_f64, 0);
    run(method, body, dt_s, 2_000, |_, state: &State| {
        n += 1;
        let at_m = state.position_m.abs();
        if n <= 200 {
            first_m = first_m.max(at_m);
        } else if n > 1_800 {
            last_m = last_m.max(at_m);
        }
        // It need not run to infinity.
        at_m < 1e-6
    });
    if n < 2_000 { f64::INFINITY } else { last_m / first_m }
}

#[test]
fn an_oscillator_under_the_scenes_step() {
    for damping in [0.0, 0.1, 0.7, 2.0] {
        let stiffness_n_per_m = 2_000.0;
        let damping_ns_per_m = 2.0 * damping * (stiffness_n_per_m * MASS_KG).sqrt();
        let body = Oscillator { stiffness_n_per_m, damping_ns_per_m, normal_n: 0.0 };
        let bound_s = bounds::semi_implicit_oscillator_s(MASS_KG, stiffness_n_per_m, damping_ns_per_m);
        let (inside, outside) = (swing(&Moreau, &body, 0.9 * bound_s), swing(&Moreau, &body, 1.1 * bound_s));
        assert!(inside <= 1.01 && outside > 100.0, "damping {damping}: {inside}, {outside}");
    }
    // Undamped it is the textbook's 2 / omega.
    assert!((bounds::semi_implicit_oscillator_s(0.2, 2_000.0, 0.0) - 0.02).abs() < 1e-15);
}

/// The LuGre methods see a sticking bristle as a spring under the body.
#[test]
fn a_sticking_bristle_under_each_lugre_method() {
    for damping in [0.1, 0.7] {
        let lugre = LuGre { damping, ..LUGRE };
        let (k, c) = (lugre.stiffness_n_per_m, lugre.damping_ns_per_m(MASS_KG));
        let cases: [(&dyn Method, f64); 3] = [
            (&ExplicitEuler(lugre), bounds::explicit_oscillator_s(MASS_KG, k, c)),
            (&RungeKutta4(lugre), bounds::runge_kutta_oscillator_s(MASS_KG, k, c)),
            (&Exponential(lugre), bounds::semi_implicit_oscillator_s(MASS_KG, k, c)),
        ];
        // So strong a contact that nothing slides.
        let body = Oscillator { stiffness_n_per_m: 0.0, damping_ns_per_m: 0.0, normal_n: 1e3 };
        for (method, bound_s) in cases {
            let (inside, outside) =
                (swing(method, &body, 0.9 * bound_s), swing(method, &body, 1.1 * bound_s));
            assert!(inside <= 1.01 && outside > 10.0, "{} at {damping}: {inside}, {outside}", method.name());
        }
        let implicit = swing(&Implicit(lugre), &body, 1e3 * cases[0].1);
        assert!(implicit <= 1.0, "implicit: {implicit}");
    }
}

#[test]
fn the_incline_within_a_thousandth_at_the_shipped_step() {
    let incline = Incline::default();
    let figures = incline.figures(&Moreau, SHIPPED_S);
    // The first is the speed after 1 s over g (sin - mu_d cos): the mean acceleration.
    assert!((figures[0] - 1.0).abs() < 1e-3, "{figures:?}");
    let onset = incline.onset_tan(&Moreau, SHIPPED_S) / incline.friction.mu_s;
    assert!((onset - 1.0).abs() < 1e-3, "{onset} of mu_s");
}

#[test]
fn the_shipped_step_is_within_1_percent_on_every_problem() {
    for problem in problems() {
        let figures = problem.figures(&Moreau, SHIPPED_S);
        let right = problem.closed_form().unwrap_or_else(|| problem.figures(&Moreau, SHIPPED_S / 1_024.0));
        let error = error(&figures, &right);
        assert!(error < 0.01, "{}: {error}", problem.name());
    }
}

#[test]
fn held_and_shaken_for_an_hour_coulomb_does_not_move_and_lugre_creeps() {
    let hour = ShakenHold { duration_s: 3_600.0 };
    assert_eq!(hour.drift_m(&Moreau, SHIPPED_S), 0.0);
    // The control: the same hold moves a bristle within ten seconds, at a step that is fine enough for it.
    let drift_m = ShakenHold { duration_s: 10.0 }.drift_m(&Implicit(LUGRE), SHIPPED_S);
    assert!(drift_m > 1e-4, "{drift_m} m");
}

/// Every figure of every problem by every method, in one number.
#[test]
fn the_same_bytes_in_every_build() {
    let mut checksum = 0_u64;
    for problem in problems() {
        for method in methods(LUGRE) {
            for figure in problem.figures(&*method, SHIPPED_S / 4.0) {
                // Two NaNs need not have the same bits.
                let bits = if figure.is_nan() { 0 } else { figure.to_bits() };
                checksum = checksum.rotate_left(5) ^ bits;
            }
        }
    }
    // If a method or a problem is changed on purpose, put the new value here, and run it in debug and release.
    assert_eq!(checksum, 0x41c1_ee93_4494_f85c, "{checksum:#018x}");
}
