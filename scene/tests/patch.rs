//! L1 in the grasp: micro slip precedes macro slip, the films hear it, and the level below has neither.

use crate::common::{Reflex, run};
use proptest::prelude::*;
use tenax_scene::physics::friction::Friction;
use tenax_scene::physics::level::{Level, Push};
use tenax_scene::{SceneFile, Truth, World, builtin};

/// The held glass with a contact of this level, without its knocks.
fn glass(level: &str) -> SceneFile {
    let text = builtin()[0].1.replace("[contact]\n", &format!("[contact]\nlevel = \"{level}\"\n"));
    let quiet = text.replace("peak_mv = 40", "peak_mv = 0").replace("peak_mv = 60", "peak_mv = 0");
    SceneFile::parse(&quiet, level).unwrap_or_else(|error| panic!("{error}"))
}

fn truth(scene: &SceneFile, reflex: Reflex) -> Truth {
    run(scene, 1, reflex, |_, _, _| {}).truth().clone()
}

#[test]
fn micro_slip_precedes_macro_slip_and_the_rigid_contact_has_none() {
    let (rigid, patch) = (truth(&glass("l0"), Reflex::Ratio), truth(&glass("l1"), Reflex::Ratio));
    let (first, second) = (rigid.slips[0], patch.slips[0]);
    assert_eq!(first.micro_onset_s, first.macro_onset_s);
    let lead_s = second.macro_onset_s - second.micro_onset_s;
    // Water takes 20 ms to halve the friction, and the patch lets go from its edge while it does.
    assert!((0.003..0.030).contains(&lead_s), "{lead_s} s");
    assert!((42.0..42.05).contains(&second.macro_onset_s), "{second:?}");
    assert!(patch.micro_slips > rigid.micro_slips);
}

/// The loudest envelope before the macro onset of the wet glass, mV.
fn warning_mv(level: &str) -> f64 {
    let mut warned: f64 = 0.0;
    let mut slipped = false;
    run(&glass(level), 1, Reflex::Ratio, |world: &World, _, mv| {
        slipped |= world.truth().slips.iter().any(|slip| slip.macro_onset_s > 42.0);
        if world.now_s() > 41.9 && !slipped {
            warned = warned.max(mv);
        }
    });
    warned
}

#[test]
fn the_films_hear_micro_slips_before_anything_slides_and_not_at_the_level_below() {
    let (rigid, patch) = (warning_mv("l0"), warning_mv("l1"));
    assert!(patch > 3.0 * rigid, "{patch} mV with micro slips, {rigid} mV without");
}

#[test]
fn a_patch_needs_a_firmer_grip_than_rigid_friction_says() {
    // L0 holds to mu_s; a patch whose edge has dropped to mu_d holds to 0.898 of it (brush with drop, its peak).
    let (rigid, patch) =
        (truth(&glass("l0"), Reflex::RatioAndVibration), truth(&glass("l1"), Reflex::RatioAndVibration));
    let ratio = patch.needed_grip_n / rigid.needed_grip_n;
    assert!((1.08..1.16).contains(&ratio), "{ratio}");
}

#[test]
fn falling_friction_shakes_the_probe_where_constant_friction_lets_it_slide() {
    // Vibration of the probe's speed in steady sliding at 30 mm/s on an arm with little damping, mm/s.
    let shaking = |level: &str, key: &str| {
        let text = format!(
            "name = \"n\"\ntitle = \"t\"\nfrom = \"assumed\"\nduration_s = 3\nslip_floor_mm_s = 0.1\n[contact]\n\
             level = \"{level}\"\nmu_s = 0.5\nmu_d = 0.4\npad_length_mm = 18\npitch_mm = 1\n{key}[robot]\n\
             damping = 0.05\n[[press]]\nat_s = 0\nfor_s = 3\nload_n = 2\n[[sweep]]\nat_s = 0.3\nfor_s = 2.7\nspeed_mm_s = 30\n"
        );
        let scene = SceneFile::parse(&text, level).unwrap();
        let world = run(&scene, 1, Reflex::None, |_, _, _| {});
        let late = world.truth().trace.iter().filter(|row| (1.8..2.6).contains(&row.t_s));
        let speeds: Vec<f64> = late.map(|row| row.slide_mm_s).collect();
        speeds.iter().copied().fold(f64::MIN, f64::max) - speeds.iter().copied().fold(f64::MAX, f64::min)
    };
    let (constant, falling) = (shaking("l0", ""), shaking("l2", "stribeck_mm_s = 20\n"));
    assert!(constant < 3.0 && falling > 20.0, "{constant} mm/s at L0, {falling} mm/s at L2");
}

/// A contact of a level, by way of a scene file.
fn level(name: &str) -> Level {
    let scene = glass(name);
    Level::of(&scene)
}

proptest! {
    #[test]
    fn friction_never_adds_energy_at_any_level(
        which in prop::sample::select(vec!["l0", "l1", "l2"]), mu_d in 0.05..1.0, excess in 0.0..0.5,
        mass_kg in 0.001..2.0, speed_m_s in -0.5..0.5,
        loads in prop::collection::vec(0.0..30.0, 2..40),
    ) {
        let friction = Friction { mu_s: mu_d + excess, mu_d };
        let mut contact = level(which);
        let mut speed_m_s: f64 = speed_m_s;
        let mut before_j = 0.5 * mass_kg * speed_m_s * speed_m_s;
        // Fingers that only let go: whoever squeezes puts energy in.
        let mut loads: Vec<f64> = loads;
        loads.sort_by(|a, b| b.total_cmp(a));
        for normal_n in loads {
            for _ in 0..20 {
                let push = Push { normal_n, pads: 2.0, friction, mass_kg, free_m_s: speed_m_s };
                let outcome = contact.step(push, 125e-6);
                speed_m_s = outcome.speed_m_s;
                let after_j = 0.5 * mass_kg * speed_m_s * speed_m_s + contact.energy_j(2.0);
                prop_assert!(after_j <= before_j * (1.0 + 1e-9) + 1e-15, "{} J after {}", after_j, before_j);
                prop_assert!(outcome.released_n >= 0.0);
                before_j = after_j;
            }
        }
    }
}

#[test]
fn held_for_a_minute_a_patch_creeps_by_nothing_that_counts() {
    let mut contact = level("l1");
    let friction = Friction { mu_s: 0.5, mu_d: 0.44 };
    let (mut speed_m_s, mut way_m) = (0.0, [0.0; 2]);
    for n in 0..480_000_u32 {
        let free_m_s = speed_m_s + 9.80665 * 125e-6;
        speed_m_s = contact
            .step(Push { normal_n: 4.0, pads: 2.0, friction, mass_kg: 0.25, free_m_s }, 125e-6)
            .speed_m_s;
        way_m[usize::from(n >= 8_000)] += speed_m_s * 125e-6;
    }
    // The first second stretches the skin by m g / 2K; from then on it stands still.
    assert!((0.5e-3..1.0e-3).contains(&way_m[0]), "{} m", way_m[0]);
    assert!(way_m[1].abs() < 1e-9, "{} m", way_m[1]);
}
