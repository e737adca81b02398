//! Whatever a scene file may state, the step of one scan fits twice into every bound, or the file is refused.
//! Asked of the worlds, not of the check: an accepted scene is run, and nothing in it may swing up or press too hard.

use proptest::prelude::*;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_scene::plant::Plant;
use tenax_scene::{SceneFile, Truth, World};

const GRAVITY_M_S2: f64 = 9.80665;

/// An object that stands on the mat, and has its own mass poured into it within a scan, so that the mat rings.
fn scene(
    mass_kg: f64,
    stiffness: f64,
    mat: f64,
    damping: f64,
    speed_mm_s: f64,
    force_n: f64,
    open_mm: f64,
) -> String {
    format!(
        "name = \"n\"\ntitle = \"t\"\nfrom = \"assumed\"\nduration_s = 1\nslip_floor_mm_s = 1\n\
         [contact]\nmu_s = 0.5\nmu_d = 0.4\npad_length_mm = 18\npitch_mm = 1\n\
         [object]\nmass_kg = {mass_kg:e}\nwidth_mm = 60\nstiffness_n_per_mm = {stiffness:e}\n\
         [table]\nmat_n_per_mm = {mat:e}\ndamping = {damping:e}\n\
         [gripper]\nspeed_mm_s = {speed_mm_s:e}\nforce_n = {force_n:e}\ndead_time_ms = 0\nopening_mm = {open_mm}\n\
         [[fill]]\nat_s = 0\nfor_s = 0.000125\nadd_kg = {mass_kg:e}\n"
    )
}

fn ran(text: &str, drive: MotorDrive) -> Truth {
    let file = SceneFile::parse(text, "drawn.toml").expect("the same numbers were accepted");
    let mut world = World::new(&file, 1);
    for _ in 0..3_200 {
        world.scan(drive);
    }
    world.truth().clone()
}

fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (0.0..1.0).prop_map(move |part: f64| low * (high / low).powf(part))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn what_is_accepted_is_stable(
        mass_kg in decades(0.0005, 10.0), stiffness in decades(0.01, 1000.0), mat in decades(0.01, 1000.0),
        damping in 0.0..2.0, speed_mm_s in decades(0.01, 500.0), force_n in decades(1.0, 200.0),
    ) {
        let with_opening = |open_mm| scene(mass_kg, stiffness, mat, damping, speed_mm_s, force_n, open_mm);
        if let Err(refusal) = SceneFile::parse(&with_opening(60.0), "drawn.toml") {
            prop_assert!(refusal.to_string().contains("125 us"), "{refusal}");
            return Ok(());
        }
        // Fingers that press with all they have never press harder than their motor's stall force.
        let pressed = ran(&with_opening(60.0), MotorDrive::Close(Duty::per_mille(1_000)));
        let strongest_n = pressed.trace.iter().fold(0.0, |most: f64, row| most.max(row.grip_n));
        prop_assert!(strongest_n <= force_n * (1.0 + 1e-9), "{strongest_n} N of {force_n} N");
        // A mat under a load that comes at once yields by twice what it yields at rest, and never further; it had
        // yielded by that once already, under the empty object.
        let stood = ran(&with_opening(90.0), MotorDrive::Coast);
        let at_rest_mm = mass_kg * GRAVITY_M_S2 / mat;
        let furthest_mm = stood.trace.iter().fold(0.0, |most: f64, row| most.max(row.position_mm.abs()));
        prop_assert!(furthest_mm <= 3.05 * at_rest_mm, "{furthest_mm} mm, {at_rest_mm} mm at rest");
    }
}
