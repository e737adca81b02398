//! L1 in the grasp: micro slip precedes macro slip, the films hear it, and the level below has neither.

use crate::common::{Reflex, changed, run};
use proptest::prelude::*;
use tenax_hal_shim::channel::{PVDF_COUNT, SCANS_PER_FRAME};
use tenax_scene::SceneFile;
use tenax_scene::physics::GRAVITY_M_S2;
use tenax_scene::physics::friction::Friction;
use tenax_scene::physics::level::{Level, Push};
use tenax_scene::stepping::SHIPPED_S;

/// The held glass with a contact of this level, without its knocks.
fn glass(level: &str) -> SceneFile {
    let level = format!("[contact]\nlevel = \"{level}\"\n");
    changed(
        "glass",
        &[("[contact]\n", &level), ("peak_mv = 40", "peak_mv = 0"), ("peak_mv = 60", "peak_mv = 0")],
    )
}

#[test]
fn micro_slip_precedes_macro_slip_the_films_hear_it_and_a_firmer_grip_is_needed() {
    let [(rigid, rigid_v), (patch, patch_v)] = ["l0", "l1"].map(|level| {
        // The largest swing of a frame's sum of a film from its mean of the second before, until the wet glass slides.
        let (mut sums, mut scans, mut rest, mut loudest_v) =
            ([0.0; PVDF_COUNT], 0, [0.0; PVDF_COUNT], 0.0_f64);
        let world = run(&glass(level), Reflex::Ratio, |world, pins| {
            let slides = world.truth().slips.iter().any(|slip| slip.macro_onset_s > 42.0);
            if world.now_s() < 40.9 || slides {
                return;
            }
            scans += 1;
            sums.iter_mut().zip(pins.0).for_each(|(sum, pin)| *sum += pin / SCANS_PER_FRAME as f64);
            if scans % SCANS_PER_FRAME == 0 {
                let now = std::mem::take(&mut sums);
                if world.now_s() < 41.9 {
                    rest.iter_mut().zip(now).for_each(|(rest, now)| *rest += now / 2_000.0);
                } else {
                    let swings = now.iter().zip(rest).map(|(now, rest)| (now - rest).abs());
                    loudest_v = swings.fold(loudest_v, f64::max);
                }
            }
        });
        (world.truth().clone(), loudest_v)
    });
    assert!(patch_v > 3.0 * rigid_v, "{patch_v} V with micro slips, {rigid_v} V without");
    let (first, second) = (rigid.slips[0], patch.slips[0]);
    assert_eq!(first.micro_onset_s, first.macro_onset_s);
    // Water takes 20 ms to halve the friction, and the patch lets go from its edge while it does.
    let lead_s = second.macro_onset_s - second.micro_onset_s;
    assert!((0.003..0.030).contains(&lead_s), "{lead_s} s");
    assert!((42.0..42.05).contains(&second.macro_onset_s), "{second:?}");
    assert!(patch.micro_slips > rigid.micro_slips);
    // L0 holds to mu_s; a patch whose edge has dropped to mu_d holds to 0.898 of it (brush with drop, its peak).
    let ratio = patch.needed_grip_n / rigid.needed_grip_n;
    assert!((1.08..1.16).contains(&ratio), "{ratio}");
}

proptest! {
    #[test]
    fn friction_never_adds_energy_at_any_level(
        which in prop::sample::select(vec!["l0", "l1"]), mu_d in 0.05..1.0, excess in 0.0..0.5,
        mass_kg in 0.001..2.0, speed_m_s in -0.5..0.5,
        loads in prop::collection::vec(0.0..30.0, 2..40),
    ) {
        let friction = Friction { mu_s: mu_d + excess, mu_d };
        let mut contact = Level::of(&glass(which));
        let mut speed_m_s: f64 = speed_m_s;
        let mut before_j = 0.5 * mass_kg * speed_m_s * speed_m_s;
        // Fingers that only let go: whoever squeezes puts energy in.
        let mut loads: Vec<f64> = loads;
        loads.sort_by(|a, b| b.total_cmp(a));
        for normal_n in loads {
            for _ in 0..20 {
                let push = Push { normal_n, pads: 2.0, friction, mass_kg, free_m_s: speed_m_s };
                let outcome = contact.step(push, SHIPPED_S);
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
    let mut contact = Level::of(&glass("l1"));
    let friction = Friction { mu_s: 0.5, mu_d: 0.44 };
    let (mut speed_m_s, mut way_m) = (0.0, [0.0; 2]);
    for n in 0..480_000_u32 {
        let free_m_s = speed_m_s + GRAVITY_M_S2 * SHIPPED_S;
        let push = Push { normal_n: 4.0, pads: 2.0, friction, mass_kg: 0.25, free_m_s };
        speed_m_s = contact.step(push, SHIPPED_S).speed_m_s;
        way_m[usize::from(n >= 8_000)] += speed_m_s * SHIPPED_S;
    }
    // The first second stretches the skin by m g / 2K; from then on it stands still.
    assert!((0.5e-3..1.0e-3).contains(&way_m[0]), "{} m", way_m[0]);
    assert!(way_m[1].abs() < 1e-9, "{} m", way_m[1]);
}
