//! What behaviours may not do: silence the reflex, drive against the wearer, open by a fault.

use tenax_hal_shim::behaviour::{Behaviour, CameraView, Ending, MARKERS};
use tenax_hal_shim::channel::{ARRAY, ARRAY_COUNT, FSR, PVDF};
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Down, EventKind, Refusal};
use tenax_hal_shim::words::DriveSource;
use tenax_host_tests::{Bench, set};
use tenax_logic::setting::SettingId;

fn view(moving_e4: u16, normal: u8, shear: i8) -> Down {
    Down::View(CameraView {
        age_ms: 30,
        moving_e4,
        angle_ddeg: Some(0),
        normal: [normal; MARKERS],
        shear: [shear; MARKERS],
    })
}

/// Runs for so long, with a picture 60 times a second.
fn watch(bench: &mut Bench, frames: u32, picture: &Down) -> Vec<MotorDrive> {
    let mut drives = Vec::new();
    for n in 0..frames {
        if n % 33 == 0 {
            bench.fingertip.command(picture).expect("a bench trusts its line");
        }
        drives.push(bench.step());
    }
    drives
}

fn ending(bench: &Bench) -> Option<Ending> {
    bench.events.iter().rev().find_map(|event| match event.kind {
        EventKind::Behaviour(_, ending) => ending,
        _ => None,
    })
}

fn opens(drives: &[MotorDrive]) -> bool {
    drives.iter().any(|drive| drive.opens())
}

fn begin(bench: &mut Bench, what: Behaviour) {
    bench.fingertip.command(&Down::Begin(what)).expect("it may begin");
}

#[test]
fn a_hand_over_opens_for_a_pull_and_not_without() {
    for (pulled, released) in [(0, false), (20, true)] {
        let mut bench = Bench::holding(1);
        watch(&mut bench, 200, &view(0, 20, 10));
        begin(&mut bench, Behaviour::HandOver);
        assert!(!opens(&watch(&mut bench, 1_000, &view(0, 20, 10))), "nobody pulls");
        let drives = watch(&mut bench, 1_000, &view(0, 20, 10 + pulled));
        assert_eq!(opens(&drives), released);
        assert_eq!(ending(&bench) == Some(Ending::Done), released);
    }
}

/// Without a camera, by the taxels.
#[test]
fn taxels_feel_a_pull_where_no_camera_does() {
    let mut bench = Bench::holding(2);
    bench.press(300.0);
    bench.run(200);
    begin(&mut bench, Behaviour::HandOver);
    assert!(!opens(&bench.run(1_000)));
    for taxel in 0..ARRAY_COUNT / 2 {
        bench.pins_mv[ARRAY + taxel] += 60.0;
        bench.pins_mv[ARRAY + ARRAY_COUNT / 2 + taxel] -= 60.0;
    }
    assert!(opens(&bench.run(400)));
}

/// Each fault during a hand-over: nothing opens, and what cannot go on ends.
// Shows W4.
#[test]
fn no_fault_opens_a_hand_that_waits_to_hand_over() {
    type Break = fn(&mut Bench);
    let faults: [(&str, Break); 7] = [
        ("a film hums", |bench| bench.pins_mv[PVDF] = 3_300.0),
        ("every film is dead", |bench| (PVDF..PVDF + 12).for_each(|film| bench.pins_mv[film] = 0.0)),
        ("every film shakes", |bench| bench.vibration_mv = 800.0),
        ("a taxel is dead", |bench| bench.pins_mv[ARRAY] = 0.0),
        ("a taxel is shorted", |bench| bench.pins_mv[ARRAY + 3] = 3_300.0),
        ("the array is dead", |bench| (ARRAY..ARRAY + ARRAY_COUNT).for_each(|n| bench.pins_mv[n] = 0.0)),
        ("a quadrant is dead", |bench| bench.pins_mv[FSR + 1] = 0.0),
    ];
    for (name, fails) in faults {
        let mut bench = Bench::holding(3);
        bench.press(300.0);
        bench.run(200);
        begin(&mut bench, Behaviour::HandOver);
        bench.run(600);
        fails(&mut bench);
        assert!(!opens(&bench.run(6_000)), "{name}");
    }
}

// Shows L6.
#[test]
fn a_camera_that_goes_dark_ends_what_it_began_and_the_hand_holds_on() {
    for what in [Behaviour::HandOver, Behaviour::GentleGrasp, Behaviour::Turn { by_ddeg: 200 }] {
        let mut bench = Bench::holding(4);
        if what == Behaviour::GentleGrasp {
            bench.load(0.0, 0.0);
            bench.run(400);
        }
        watch(&mut bench, 200, &view(0, if what == Behaviour::GentleGrasp { 0 } else { 20 }, 0));
        begin(&mut bench, what);
        bench.run(300);
        let drives = bench.run(1_000);
        assert_eq!(ending(&bench), Some(Ending::SensorLost), "{what:?}");
        assert!(drives[200..].iter().all(|drive| *drive == MotorDrive::Coast), "{what:?}");
        // And its reflex is back.
        bench.load(4.0, 0.6);
        bench.run(600);
        bench.vibration_mv = 800.0;
        assert!(bench.run(400).iter().any(|drive| drive.closes()), "{what:?}");
    }
}

// Shows L4.
#[test]
fn holding_never_silences_the_reflex() {
    let mut bench = Bench::holding(5);
    begin(&mut bench, Behaviour::Hold);
    watch(&mut bench, 400, &view(0, 20, 0));
    assert!(!bench.run(200).iter().any(|drive| drive.closes()));
    bench.vibration_mv = 800.0;
    bench.slows.clear();
    watch(&mut bench, 400, &view(0, 20, 0));
    assert!(bench.by_reflex() > 0);
}

#[test]
fn holding_closes_a_little_for_what_only_the_camera_sees() {
    // Without shear it sticks, whatever seems to move: the picture is wrong.
    for (moving_e4, shear, closes) in [(5, 1, false), (60, 1, true), (60, 0, false)] {
        let mut bench = Bench::new(6);
        bench.run(600);
        watch(&mut bench, 100, &view(0, 1, 0));
        begin(&mut bench, Behaviour::Hold);
        let drives = watch(&mut bench, 100, &view(moving_e4, 1, shear));
        assert_eq!(drives.iter().any(|drive| drive.closes()), closes);
    }
}

// Shows W2.
#[test]
fn the_wearer_ends_every_behaviour() {
    for what in [
        Behaviour::Stroke,
        Behaviour::GentleGrasp,
        Behaviour::Hold,
        Behaviour::HandOver,
        Behaviour::Turn { by_ddeg: -200 },
    ] {
        let mut bench = Bench::holding(7);
        watch(&mut bench, 100, &view(0, 20, 0));
        begin(&mut bench, what);
        if bench.fingertip.behaviour().is_none() {
            continue;
        }
        bench.step();
        bench.muscles(900.0, 50.0);
        bench.run(60);
        assert_eq!(bench.fingertip.behaviour(), None, "{what:?}");
        assert_eq!(bench.fingertip.command(&Down::Begin(what)), Err(Refusal::WearerActive));
        bench.slows.clear();
        watch(&mut bench, 200, &view(200, 20, 100));
        assert!(bench.ticks().all(|tick| tick.source != DriveSource::Behaviour), "{what:?}");
    }
}

// Shows L2.
#[test]
fn what_opens_needs_consent_as_long_as_it_lasts() {
    for revoked in [false, true] {
        let mut bench = Bench::holding(8);
        bench.press(300.0);
        // What consent there was at power-up is over after 10 s.
        bench.run(22_000);
        begin(&mut bench, Behaviour::HandOver);
        if revoked {
            bench
                .fingertip
                .command(&set(SettingId::LineTrusted, 0))
                .expect("a trusted line may give it back");
        }
        bench.run(2_000);
        (0..ARRAY_COUNT).for_each(|taxel| bench.pins_mv[ARRAY + taxel] += 200.0);
        assert_eq!(opens(&bench.run(2_000)), !revoked);
        assert_eq!(ending(&bench), Some(if revoked { Ending::NotArmed } else { Ending::Done }));
    }
}

#[test]
fn a_turn_that_falls_is_the_reflexs() {
    let mut bench = Bench::holding(9);
    watch(&mut bench, 100, &view(0, 20, 0));
    begin(&mut bench, Behaviour::Turn { by_ddeg: 200 });
    watch(&mut bench, 200, &view(0, 20, 0));
    bench.vibration_mv = 800.0;
    bench.slows.clear();
    watch(&mut bench, 1_400, &view(200, 20, 0));
    assert!(bench.by_reflex() > 0);
    assert!(bench.ticks().all(|tick| !tick.drive.opens()), "it slips: nothing is loosened");
}

// Shows R7.
#[test]
fn lost_frames_move_nothing() {
    let mut bench = Bench::new(10);
    bench.run(600);
    watch(&mut bench, 100, &view(0, 0, 0));
    begin(&mut bench, Behaviour::GentleGrasp);
    assert!(watch(&mut bench, 100, &view(0, 0, 0)).iter().any(|drive| drive.closes()), "it grasps");
    for _ in 0..200 {
        let lost = Frame::lost(bench.frame().sequence);
        assert_eq!(bench.give(&lost), MotorDrive::Coast);
    }
}

/// A camera that sees motion for ever is broken: what it adds ends.
// Shows L6.
#[test]
fn a_camera_that_sees_motion_for_ever_closes_the_hand_for_half_a_second() {
    let mut bench = Bench::holding(11);
    watch(&mut bench, 200, &view(0, 20, 10));
    begin(&mut bench, Behaviour::Hold);
    let closing = |drives: &[MotorDrive]| drives.iter().filter(|drive| drive.closes()).count();
    // Ever faster, so for less than half of that: as far as half a second of usual closing.
    let closed = closing(&watch(&mut bench, 20_000, &view(200, 20, 10)));
    assert!((400..=460).contains(&closed), "{closed} frames of 0.5 ms");
    watch(&mut bench, 1_000, &view(0, 20, 10));
    assert!(closing(&watch(&mut bench, 1_000, &view(200, 20, 10))) > 0, "it has been still");
}

/// What a camera alone sees opens nothing: light changes too.
// Shows L6.
#[test]
fn motion_in_the_picture_is_no_pull_unless_the_skin_feels_one() {
    // A card's pull is too small for any one marker, and not for all of them.
    for (shear, released) in [(10, false), (11, true), (20, true)] {
        let mut bench = Bench::holding(12);
        watch(&mut bench, 200, &view(0, 20, 10));
        begin(&mut bench, Behaviour::HandOver);
        watch(&mut bench, 600, &view(0, 20, 10));
        assert_eq!(opens(&watch(&mut bench, 2_000, &view(200, 20, shear))), released, "{shear}");
    }
}

/// Nothing that would feel it says that it slips: the grasp is loosened by so much, and no further.
// Shows L6.
#[test]
fn a_turn_in_which_nothing_slips_gives_up_before_the_object_falls() {
    let mut bench = Bench::holding(13);
    watch(&mut bench, 200, &view(0, 20, 0));
    begin(&mut bench, Behaviour::Turn { by_ddeg: 200 });
    bench.load(1.9, 0.1);
    let drives = watch(&mut bench, 4_000, &view(0, 20, 0));
    assert!(opens(&drives[..200]), "it is loosened first");
    bench.load(1.2, 0.1);
    let drives = watch(&mut bench, 4_000, &view(0, 20, 0));
    assert!(!opens(&drives[100..]), "less than a third is left of the grasp");
    assert!(drives.iter().any(|drive| drive.closes()), "it is as firm as before");
    assert_eq!(ending(&bench), Some(Ending::NoSlip));
}

/// A turn may silence the reflex no longer than a drive, and leaves no loosened grasp.
// Shows L4.
#[test]
fn a_turn_that_takes_too_long_makes_the_grasp_as_firm_as_before() {
    let mut bench = Bench::holding(15);
    bench.fingertip.command(&set(SettingId::LineTrusted, 0)).expect("a trusted line may give it back");
    for step in 0..600 {
        bench.fingertip.button((100..400).contains(&step));
        bench.step();
    }
    watch(&mut bench, 200, &view(0, 20, 0));
    begin(&mut bench, Behaviour::Turn { by_ddeg: 200 });
    let loosens = watch(&mut bench, 19_000, &view(0, 20, 0));
    let firms = watch(&mut bench, 20_000, &view(0, 20, 0));
    let sum = |drives: &[MotorDrive]| -> i32 {
        let each = drives.iter().map(|drive| match drive {
            MotorDrive::Open(duty) => i32::from(duty.as_per_mille()),
            MotorDrive::Close(duty) => -i32::from(duty.as_per_mille()),
            MotorDrive::Coast => 0,
        });
        each.sum()
    };
    assert!(
        sum(&loosens) > 0 && !loosens.iter().any(|drive| drive.closes()),
        "nothing slips: it only loosens"
    );
    assert!(!opens(&firms[1_000..]) && sum(&loosens) + sum(&firms) <= 0, "{} {}", sum(&loosens), sum(&firms));
    assert_eq!(ending(&bench), Some(Ending::TooLong));
}

/// Begun again and again, behaviours that answer slip themselves take of the line's 10 s; then the reflex listens for as long.
// Shows L4.
#[test]
fn a_row_of_behaviours_silences_the_reflex_no_longer_than_a_drive() {
    for (what, longest_ms) in [(Behaviour::HandOver, 10_000), (Behaviour::Stroke, 60_000)] {
        let mut bench = Bench::holding(14);
        bench.press(300.0);
        bench.run(600);
        bench.fingertip.command(&set(SettingId::LineTrusted, 0)).expect("a trusted line may give it back");
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
