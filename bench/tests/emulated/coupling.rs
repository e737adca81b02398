//! The bridge's edges in the films' samples: with the phase that the image sets no rising edge is in them, by chance one can be.

use tenax_bench::board::emulated::Options;
use tenax_bench::board::emulated::coupling::Coupling;
use tenax_hal_shim::channel::{PVDF_COUNT, SCAN_LEN, SCANS_PER_FRAME};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::Down;

use crate::{Rest, Swing, drives, run};

/// 100 mV that are gone after 0.3 us.
const EDGE: Coupling = Coupling { codes: 124.0, gone_us: 0.3, begins_us: None };

/// The farthest that a film's sample is from rest while the image drives, codes of four scans.
fn worst(begins_us: Option<f64>) -> u32 {
    let drive = MotorDrive::Close(Duty::per_mille(400));
    let plant = Rest::new(Swing::new(0.7).sending(0.4, Down::Drive { drive, hold_ms: 200 }));
    let coupling = Some(Coupling { begins_us, ..EDGE });
    let run = run(plant, &Options { coupling, ..Options::default() });
    assert!(drives(&run, 0.45, 0.55).contains(&drive));
    let (frames, _) = run.scans.as_chunks::<SCANS_PER_FRAME>();
    let sample = |frame: &[[u16; SCAN_LEN]; SCANS_PER_FRAME], film: usize| -> u32 {
        frame.iter().map(|scan| u32::from(scan[film])).sum()
    };
    let rest = &frames[10];
    frames
        .iter()
        .flat_map(|frame| (0..PVDF_COUNT).map(|film| sample(frame, film).abs_diff(sample(rest, film))))
        .max()
        .unwrap_or(0)
}

#[test]
fn a_rising_edge_is_in_a_films_sample_by_chance_and_never_with_the_images_phase() {
    let [image, chance] = [None, Some(2.2)].map(worst);
    println!("worst film: {image} codes with the image's phase, {chance} where an edge meets a sampling");
    // Two of a frame's four scans have it.
    assert!(chance > 200, "the control: {chance}");
    assert!(image <= 4, "{image}");
}

/// Over every duty, what the two kinds of edges leave in the worst film, codes of one scan.
fn worst_of_duties(begins_us: f64) -> (f64, usize) {
    let (mut most, mut met) = (0.0_f64, 0);
    for permille in 20..980 {
        let mut worst = 0.0_f64;
        // A scan takes two and a half periods: every other one begins in the middle of one.
        for begins_us in [begins_us, begins_us + 25.0] {
            let mut scan = [2_048; SCAN_LEN];
            EDGE.add(&mut scan, MotorDrive::Close(Duty::per_mille(permille)), begins_us.rem_euclid(50.0));
            worst = scan.iter().map(|code| (f64::from(*code) - 2_048.0).abs()).fold(worst, f64::max);
        }
        most = most.max(worst);
        met += usize::from(worst > 10.0);
    }
    (most, met)
}

/// Falling edges move with the duty: no phase keeps them out of every sampling.
#[test]
fn falling_edges_meet_a_sampling_at_some_duties_at_any_phase() {
    let image = worst_of_duties(13.6);
    let others: Vec<(f64, usize)> = (0..250).map(|n| worst_of_duties(f64::from(n) / 10.0)).collect();
    let least = others.iter().map(|own| own.1).min().unwrap_or(0);
    let most = others.iter().map(|own| own.1).max().unwrap_or(0);
    println!(
        "of 960 duties, more than 10 codes at {} with the image's phase; {least} to {most} at others",
        image.1
    );
    assert!(least > 0 && image.1 < most, "{image:?}, {least} to {most}");
}
