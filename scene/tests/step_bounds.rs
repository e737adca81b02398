//! The scenes' own step against what has a closed form: Moreau's, with Coulomb's friction as the impulse that stops the motion, and
//! semi-implicit Euler for everything else (Moreau 1988; Stewart and Trinkle 1996).

use std::f64::consts::PI;

use tenax_scene::physics::GRAVITY_M_S2;
use tenax_scene::physics::contact::RigidCoulomb;
use tenax_scene::physics::friction::Friction;
use tenax_scene::stepping::SHIPPED_S;

const FRICTION: Friction = Friction { mu_s: 0.5, mu_d: 0.4 };
const MASS_KG: f64 = 0.2;

struct Load {
    force_n: f64,
    normal_n: f64,
    surface_m_s: f64,
}

#[derive(Default)]
struct State {
    t_s: f64,
    position_m: f64,
    speed_m_s: f64,
    slid_m: f64,
    contact: RigidCoulomb,
}

fn run(duration_s: f64, load: impl Fn(f64, f64, f64) -> Load, mut look: impl FnMut(&State)) {
    let mut state = State::default();
    for n in 1..=(duration_s / SHIPPED_S).round() as u64 {
        let t_s = n as f64 * SHIPPED_S;
        let load = load(t_s, state.position_m, state.speed_m_s);
        let free_m_s = state.speed_m_s + load.force_n / MASS_KG * SHIPPED_S - load.surface_m_s;
        let slide_m_s = state.contact.step(load.normal_n, FRICTION, MASS_KG, free_m_s, SHIPPED_S).speed_m_s;
        state.speed_m_s = slide_m_s + load.surface_m_s;
        state.position_m += state.speed_m_s * SHIPPED_S;
        state.slid_m += slide_m_s * SHIPPED_S;
        state.t_s = t_s;
        look(&state);
    }
}

fn within(part: f64, found: f64, right: f64) {
    assert!((found / right - 1.0).abs() < part, "{found} instead of {right}");
}

#[test]
fn stick_slip_has_the_amplitude_and_the_period_of_its_limit_cycle() {
    const STIFFNESS_N_PER_M: f64 = 1_000.0;
    const BELT_M_S: f64 = 0.01;
    const NORMAL_N: f64 = 2.0;
    let omega_rad_s = (STIFFNESS_N_PER_M / MASS_KG).sqrt();
    let balance_m = FRICTION.mu_d * NORMAL_N / STIFFNESS_N_PER_M;
    // The spring beyond its sliding balance when the block breaks loose; the arc starts there with the belt's speed.
    let excess_m = (FRICTION.mu_s - FRICTION.mu_d) * NORMAL_N / STIFFNESS_N_PER_M;
    let amplitude_m = excess_m.hypot(BELT_M_S / omega_rad_s);
    // It sticks over twice the excess, and slides the rest of the arc.
    let angle_rad = (excess_m * omega_rad_s).atan2(BELT_M_S);
    let period_s = 2.0 * excess_m / BELT_M_S + 2.0 * (PI - angle_rad) / omega_rad_s;

    let (mut low_m, mut high_m) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut before_m, mut crossings) = (f64::NAN, Vec::new());
    let load = |_, position_m: f64, _| Load {
        force_n: -STIFFNESS_N_PER_M * position_m,
        normal_n: NORMAL_N,
        surface_m_s: BELT_M_S,
    };
    run(2.0, load, |state| {
        let at_m = state.position_m - balance_m;
        if state.t_s > 1.0 {
            (low_m, high_m) = (low_m.min(at_m), high_m.max(at_m));
            if before_m <= 0.0 && at_m > 0.0 {
                crossings.push(state.t_s - SHIPPED_S * at_m / (at_m - before_m));
            }
        }
        before_m = at_m;
    });
    let (first_s, last_s) = (crossings[0], crossings[crossings.len() - 1]);
    within(0.01, (high_m - low_m) / 2.0, amplitude_m);
    within(0.01, (last_s - first_s) / (crossings.len() - 1) as f64, period_s);
}

/// A block that is loaded gently to 60 % of the friction that it has and shaken by 15 %: never as much as sliding takes. A model
/// with bristles creeps there (Dupont, Hayward, Armstrong and Altpeter 2002).
#[test]
fn held_and_shaken_for_an_hour_it_does_not_move() {
    let normal_n = MASS_KG * GRAVITY_M_S2 / (0.6 * FRICTION.mu_s);
    let load = |part: f64| {
        move |t_s: f64, _: f64, _: f64| {
            // A triangle of 20 Hz, so that an hour of it costs no sines.
            let shake = 0.15 * (4.0 * ((20.0 * t_s).fract() - 0.5).abs() - 1.0);
            let force_n = (2.0 * t_s).min(1.0) * (part + shake) * FRICTION.mu_s * normal_n;
            Load { force_n, normal_n, surface_m_s: 0.0 }
        }
    };
    let slid_m = |part: f64, duration_s: f64| {
        let mut slid_m = 0.0;
        run(duration_s, load(part), |state| slid_m = state.slid_m);
        slid_m
    };
    assert_eq!(slid_m(0.6, 3_600.0), 0.0);
    // The control: a little more, and the same shaking moves it.
    assert!(slid_m(0.9, 10.0) > 1e-3);
}
