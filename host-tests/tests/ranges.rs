//! No legal combination of settings crushes, opens or deafens the hand to its wearer: every pair at its ends (the ranges of the
//! rows in `logic/src/*/settings.rs`). Only a mask of all detectors or an S1 above every vibration leaves slip unanswered.

use std::num::NonZero;

use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::words::Kept;
use tenax_host_tests::{Bench, wearer};
use tenax_logic::config::Config;
use tenax_logic::fingertip::Fingertip;
use tenax_logic::setting::SettingId;
use tenax_logic::store::payload;

/// Fn that a frame of full closing adds on a stiff object, N: 25 mm/s of a finger against 1 N/mm.
const N_PER_FRAME: f64 = 0.0125;
/// Slip is answered within this, in frames: 200 ms.
const ANSWER_FRAMES: u32 = 400;
/// A contraction opens within this, in frames: 50 ms.
const OPEN_FRAMES: u32 = 100;
/// What is added after the ceiling is passed, N: the force is known 80 times a second, and the filter's lag.
const STOP_N: f64 = 1.0;

/// Every pair of settings, each at both of its ends.
fn pairs() -> Vec<[(SettingId, i32); 2]> {
    let ends = |id: SettingId| [(id, id.row().min), (id, id.row().max)];
    let all: Vec<_> = SettingId::ALL.into_iter().filter(|id| *id != SettingId::LineTrusted).collect();
    let mut pairs = Vec::new();
    for (n, &one) in all.iter().enumerate() {
        for &other in &all[n + 1..] {
            pairs.extend(ends(one).into_iter().flat_map(|one| ends(other).map(|other| [one, other])));
        }
    }
    pairs
}

/// A hand with these settings that holds 2.5 N at a ratio of 0.1.
fn holding(settings: &[(SettingId, i32)]) -> Bench {
    let mut config = Config::default();
    for &(id, value) in settings {
        config.set(id, value).expect("its own end is in its range");
    }
    let mut bench = Bench::new(1);
    bench.fingertip = Fingertip::new(config);
    bench.fingertip.restore(Kept::Emg, &payload::of_emg(&wearer()));
    bench.run(200);
    bench.load(2.5, 0.25);
    // The muscles have their tone.
    bench.muscles(50.0, 50.0);
    // The longest hold of a muscle, twice.
    bench.run(2_400);
    bench
}

fn moves(drives: &[MotorDrive]) -> bool {
    drives.iter().any(|drive| *drive != MotorDrive::Coast)
}

/// Slip detection is switched off on purpose: by the mask, or by an S1 above every vibration.
fn is_off(settings: &[(SettingId, i32)]) -> bool {
    [SettingId::DetectorsOff, SettingId::S1].iter().any(|id| settings.contains(&(*id, id.row().max)))
}

fn check(settings: &[(SettingId, i32)]) {
    let mut bench = holding(settings);
    assert!(!moves(&bench.run(1_000)), "{settings:?}: a hand at rest moves");

    // It slips: vibration of 0.5 V, and shear that grows.
    let mut slipping = bench;
    let mut before = slipping.fingertip.clone();
    let seen = (slipping.pins_mv, slipping.frames);
    slipping.vibration_mv = 500.0;
    slipping.load(2.5, 0.7);
    let drives = slipping.run(ANSWER_FRAMES);
    let answered = drives.iter().position(|drive| drive.closes());
    assert!(answered.is_some() || is_off(settings), "{settings:?}: slip is not answered");
    assert!(drives.iter().all(|drive| !drive.opens()), "{settings:?}: slip opens");

    // The wearer opens.
    let mut opening = Bench::new(2);
    core::mem::swap(&mut opening.fingertip, &mut before);
    (opening.pins_mv, opening.frames) = seen;
    // Clearly above the level at which the calibrated wearer opens, 672 mV.
    opening.muscles(50.0, 900.0);
    assert!(
        opening.run(OPEN_FRAMES).iter().any(|drive| drive.opens()),
        "{settings:?}: deaf to a contraction"
    );
    opening.muscles(50.0, 50.0);
    opening.run(60);
    assert!(!moves(&opening.run(100)), "{settings:?}: goes on opening");
}

/// Closes on something stiff that slips all the time; the force that it ends with, N.
fn squeezed_n(settings: &[(SettingId, i32)]) -> f64 {
    let mut bench = holding(settings);
    let mut fn_n = 2.5;
    bench.vibration_mv = 500.0;
    for _ in 0..20_000 {
        bench.load(fn_n, 0.8 * fn_n);
        if bench.step().closes() {
            fn_n += N_PER_FRAME;
        }
    }
    fn_n
}

/// Checks each of them, on all cores: it takes half a minute on one.
fn on_all_cores<T: Sync>(items: &[T], check: impl Fn(&T) + Sync) {
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
    std::thread::scope(|scope| {
        for part in items.chunks(items.len().div_ceil(cores)) {
            scope.spawn(|| part.iter().for_each(&check));
        }
    });
}

// Shows W6.
#[test]
fn every_pair_at_its_ends_rests_answers_slip_and_opens() {
    let pairs = pairs();
    println!("{} combinations", pairs.len());
    on_all_cores(&pairs, |pair| check(pair));
}

/// The control: without anything set, the reflex does close until the ceiling.
// Shows R2.
#[test]
fn the_defaults_close_up_to_the_ceiling() {
    let n = squeezed_n(&[(SettingId::ForceCeiling, 10_000)]);
    assert!((6.0..11.0).contains(&n), "{n} N");
}

// Shows R2.
#[test]
fn every_setting_at_its_ends_stops_at_the_ceiling() {
    let all: Vec<_> = SettingId::ALL.into_iter().filter(|id| *id != SettingId::LineTrusted).collect();
    on_all_cores(&all, |&id| {
        for value in [id.row().min, id.row().max] {
            for ceiling in [3_000, 10_000] {
                let ceiling_n = f64::from(ceiling) / 1e3;
                let settings = [(SettingId::ForceCeiling, ceiling), (id, value)];
                let settings = if id == SettingId::ForceCeiling { &settings[..1] } else { &settings[..] };
                let n = squeezed_n(settings);
                // The sensor's Fn is not the physical one: see `tenax_logic::force::sensor`. What is compared is what stops it.
                assert!(n < ceiling_n + STOP_N, "{settings:?}: {n} N");
            }
        }
    });
}
