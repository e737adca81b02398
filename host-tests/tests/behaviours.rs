//! Limits of behaviours: none silences the reflex for long, drives against the wearer, or opens by a fault.

use tenax_hal_shim::behaviour::{Behaviour, CameraView, Ending, MARKERS};
use tenax_hal_shim::channel::{ARRAY, ARRAY_COUNT, FSR, PVDF, PVDF_COUNT};
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Down, EventKind, Refusal};
use tenax_hal_shim::words::DriveSource;
use tenax_host_tests::{Bench, closed_mm, closes, closing_frames, opened_mm, opens, rests, set};
use tenax_logic::setting::SettingId;

const TURN: Behaviour = Behaviour::Turn { by_ddeg: 200 };
fn distrust() -> Down {
    set(SettingId::LineTrusted, 0)
}

fn view(moving_e4: u16, normal: u8, shear: i8) -> Down {
    Down::View(CameraView {
        age_ms: 30,
        moving_e4,
        angle_ddeg: Some(0),
        normal: [normal; MARKERS],
        shear: [shear; MARKERS],
    })
}

fn still(shear: i8) -> Down {
    view(0, 20, shear)
}

fn watch(bench: &mut Bench, frames: u32, picture: Down) -> Vec<MotorDrive> {
    let mut drives = Vec::new();
    for n in 0..frames {
        if n % 33 == 0 {
            bench.accepts(picture);
        }
        drives.push(bench.step());
    }
    drives
}

fn ending(bench: &Bench) -> Option<Ending> {
    let ending = |kind| if let EventKind::Behaviour(_, ending) = kind { Some(ending) } else { None };
    bench.kinds().filter_map(ending).last().flatten()
}

fn holding(seed: u64, shear: i8, what: Behaviour) -> Bench {
    let mut bench = Bench::holding(seed);
    watch(&mut bench, 200, still(shear));
    bench.accepts(Down::Begin(what));
    bench
}

fn pressed(seed: u64) -> Bench {
    let mut bench = Bench::holding(seed);
    bench.press(300.0);
    bench.run(600);
    bench
}

/// Motion in the picture alone opens nothing: light changes too. A card's pull is too small for one marker, and not for all.
// Shows L6.
#[test]
fn a_hand_over_opens_for_a_pull_that_the_skin_feels_and_not_without() {
    for (moving_e4, pulled, released) in
        [(0, 0, false), (0, 20, true), (200, 0, false), (200, 1, true), (200, 10, true)]
    {
        let mut bench = holding(1, 10, Behaviour::HandOver);
        assert!(!opens(&watch(&mut bench, 1_000, still(10))), "nobody pulls");
        let drives = watch(&mut bench, 2_000, view(moving_e4, 20, 10 + pulled));
        assert_eq!(opens(&drives), released, "motion {moving_e4}, pull {pulled}");
        assert_eq!(ending(&bench) == Some(Ending::Done), released);
    }
    let mut bench = pressed(2);
    bench.accepts(Down::Begin(Behaviour::HandOver));
    assert!(!opens(&bench.run(1_000)));
    for taxel in 0..ARRAY_COUNT {
        bench.pins_mv[ARRAY + taxel] += if taxel < ARRAY_COUNT / 2 { 60.0 } else { -60.0 };
    }
    assert!(opens(&bench.run(400)), "taxels feel a pull");
}

// Shows W4.
#[test]
fn no_fault_opens_a_hand_that_waits_to_hand_over() {
    type Break = fn(&mut Bench);
    let faults: [(&str, Break); 7] = [
        ("a film hums", |bench| bench.pins_mv[PVDF] = 3_300.0),
        ("every film is dead", |bench| bench.pins_mv[PVDF..PVDF + PVDF_COUNT].fill(0.0)),
        ("every film shakes", |bench| bench.vibration_mv = 800.0),
        ("a taxel is dead", |bench| bench.pins_mv[ARRAY] = 0.0),
        ("a taxel is shorted", |bench| bench.pins_mv[ARRAY + 3] = 3_300.0),
        ("the array is dead", |bench| bench.pins_mv[ARRAY..ARRAY + ARRAY_COUNT].fill(0.0)),
        ("a quadrant is dead", |bench| bench.pins_mv[FSR + 1] = 0.0),
    ];
    for (name, fails) in faults {
        let mut bench = pressed(3);
        bench.accepts(Down::Begin(Behaviour::HandOver));
        bench.run(600);
        fails(&mut bench);
        assert!(!opens(&bench.run(6_000)), "{name}");
    }
}

// Shows L6.
#[test]
fn a_camera_that_goes_dark_ends_what_it_began_and_the_hand_holds_on() {
    for what in [Behaviour::HandOver, Behaviour::GentleGrasp, TURN] {
        let mut bench = Bench::holding(4);
        let empty = what == Behaviour::GentleGrasp;
        if empty {
            bench.load(0.0, 0.0);
            bench.run(400);
        }
        watch(&mut bench, 200, view(0, if empty { 0 } else { 20 }, 0));
        bench.accepts(Down::Begin(what));
        bench.run(300);
        let drives = bench.run(1_000);
        assert_eq!(ending(&bench), Some(Ending::SensorLost), "{what:?}");
        assert!(rests(&drives[200..]), "{what:?}");
        bench.load(4.0, 0.6);
        bench.run(600);
        bench.vibration_mv = 800.0;
        assert!(closes(&bench.run(400)), "{what:?}: the reflex is back");
    }
}

// Shows L4.
#[test]
fn holding_never_silences_the_reflex_nor_does_a_turn_that_falls() {
    for (what, moving_e4, frames) in [(Behaviour::Hold, 0, 400), (TURN, 200, 1_400)] {
        let mut bench = holding(5, 0, what);
        watch(&mut bench, 400, still(0));
        if what == Behaviour::Hold {
            assert!(!closes(&bench.run(200)));
        }
        bench.vibration_mv = 800.0;
        bench.slows.clear();
        let drives = watch(&mut bench, frames, view(moving_e4, 20, 0));
        assert!(bench.by_reflex() > 0, "{what:?}");
        assert!(!opens(&drives), "{what:?}: it slips, nothing is loosened");
    }
}

#[test]
fn holding_closes_a_little_for_slip_that_only_the_camera_sees() {
    // Without shear it sticks, whatever seems to move: the picture is wrong.
    for (moving_e4, shear, closing) in [(5, 1, false), (60, 1, true), (60, 0, false)] {
        let mut bench = Bench::new(6);
        bench.run(600);
        watch(&mut bench, 100, view(0, 1, 0));
        bench.accepts(Down::Begin(Behaviour::Hold));
        assert_eq!(closes(&watch(&mut bench, 100, view(moving_e4, 1, shear))), closing);
    }
}

// Shows W2.
#[test]
fn the_wearer_ends_every_behaviour() {
    for what in [Behaviour::Stroke, Behaviour::Hold, Behaviour::HandOver, TURN] {
        let mut bench = holding(7, 0, what);
        bench.step();
        assert!(bench.fingertip.behaviour().is_some(), "{what:?}");
        bench.muscles(900.0, 50.0);
        bench.run(60);
        assert_eq!(bench.fingertip.behaviour(), None, "{what:?}");
        assert_eq!(bench.fingertip.command(&Down::Begin(what)), Err(Refusal::WearerActive));
        bench.slows.clear();
        watch(&mut bench, 200, view(200, 20, 100));
        assert!(bench.ticks().all(|tick| tick.source != DriveSource::Behaviour), "{what:?}");
    }
}

// Shows L2.
#[test]
fn a_hand_over_needs_consent_as_long_as_it_lasts() {
    for revoked in [false, true] {
        let mut bench = pressed(8);
        // The consent of power-up is over after 10 s.
        bench.run(22_000);
        bench.accepts(Down::Begin(Behaviour::HandOver));
        if revoked {
            bench.accepts(distrust());
        }
        bench.run(2_000);
        bench.pins_mv[ARRAY..ARRAY + ARRAY_COUNT].iter_mut().for_each(|mv| *mv += 200.0);
        assert_eq!(opens(&bench.run(2_000)), !revoked);
        assert_eq!(ending(&bench), Some(if revoked { Ending::NotArmed } else { Ending::Done }));
    }
}

// Shows R7.
#[test]
fn lost_frames_move_nothing() {
    let mut bench = Bench::new(10);
    bench.run(600);
    watch(&mut bench, 100, view(0, 0, 0));
    bench.accepts(Down::Begin(Behaviour::GentleGrasp));
    assert!(closes(&watch(&mut bench, 100, view(0, 0, 0))), "it grasps");
    for _ in 0..200 {
        let lost = Frame::lost(bench.frame().sequence);
        assert_eq!(bench.give(&lost), MotorDrive::Coast);
    }
}

/// A camera that sees motion for ever is broken.
// Shows L6.
#[test]
fn a_camera_that_sees_motion_for_ever_closes_the_hand_for_half_a_second() {
    let mut bench = holding(11, 10, Behaviour::Hold);
    // Ever faster, so for less than half a second: as far as half a second of usual closing.
    let closed = closing_frames(&watch(&mut bench, 20_000, view(200, 20, 10)));
    assert!((400..=460).contains(&closed), "{closed} frames of 0.5 ms");
    watch(&mut bench, 1_000, still(10));
    assert!(closes(&watch(&mut bench, 1_000, view(200, 20, 10))), "it has been still");
}

// Shows L6.
#[test]
fn a_turn_in_which_nothing_slips_gives_up_before_the_object_falls() {
    let mut bench = holding(13, 0, TURN);
    bench.load(1.9, 0.1);
    let drives = watch(&mut bench, 4_000, still(0));
    assert!(opens(&drives[..200]), "it is loosened first");
    bench.load(1.2, 0.1);
    let drives = watch(&mut bench, 4_000, still(0));
    assert!(!opens(&drives[100..]), "less than a third is left of the grasp");
    assert!(closes(&drives), "it is as firm as before");
    assert_eq!(ending(&bench), Some(Ending::NoSlip));
}

/// A turn may silence the reflex no longer than a drive, and leaves no loosened grasp.
// Shows L4.
#[test]
fn a_turn_that_takes_too_long_makes_the_grasp_as_firm_as_before() {
    let mut bench = Bench::holding(15);
    bench.accepts(distrust());
    bench.run(100);
    bench.press_button(300);
    watch(&mut bench, 200, still(0));
    bench.accepts(Down::Begin(TURN));
    let loosens = watch(&mut bench, 19_000, still(0));
    let firms = watch(&mut bench, 20_000, still(0));
    let closed_mm = |drives: &[MotorDrive]| drives.iter().map(|drive| closed_mm(*drive)).sum::<f64>();
    assert!(opens(&loosens) && !closes(&loosens), "nothing slips: it only loosens");
    assert!(!opens(&firms[1_000..]));
    assert!(closed_mm(&firms) > opened_mm(&loosens) + opened_mm(&firms) - 1e-9);
    assert_eq!(ending(&bench), Some(Ending::TooLong));
}

/// Behaviours that answer slip themselves use the line's 10 s, however often they begin; then the reflex listens for as long.
// Shows L4.
#[test]
fn a_row_of_behaviours_silences_the_reflex_no_longer_than_a_drive() {
    for (what, longest_ms) in [(Behaviour::HandOver, 10_000), (Behaviour::Stroke, 60_000)] {
        let mut bench = pressed(14);
        bench.accepts(distrust());
        let (mut silent, mut listened, mut worst, mut refused) = (0, 0, 0, 0);
        for step in 0..400_000_u32 {
            bench.fingertip.button((100..400).contains(&step));
            if step % 1_000 == 500 && step > 2_000 {
                let answer = bench.fingertip.command(&Down::Begin(what));
                refused += u32::from(answer == Err(Refusal::HeldTooLong));
            }
            bench.step();
            listened = if bench.fingertip.behaviour().is_some() { 0 } else { listened + 1 };
            silent = if listened < 1_000 { silent + 1 } else { 0 };
            worst = worst.max(silent);
        }
        let longest = longest_ms * 2 + 1_000;
        assert!((longest_ms * 2 - 20..=longest).contains(&worst), "{what:?}: {worst} frames");
        assert!(refused > 10, "{what:?}: {refused}");
    }
}
