//! The bridge's edges in the films' samples: with the places that the image gives them none is in any, at whatever duty.

use tenax_hal_shim::channel::{PVDF_COUNT, SCAN_LEN, SCANS_PER_FRAME};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::Down;
use tenax_sim::board::emulated::Options;
use tenax_sim::board::emulated::coupling::Coupling;

use crate::{Swing, run};

/// 100 mV that are gone after 0.3 us.
const EDGE: Coupling = Coupling { codes: 124.0, gone_us: 0.3, late_us: 0.0 };
/// An edge is in a sample of one scan that is farther from rest, codes.
const MET: u16 = 10;
const DUTIES: std::ops::Range<u16> = 20..980;
const EACH_S: f64 = 0.002;

/// Drives each `step`th duty in turn: duties that were seen, and those with an edge in a sample.
fn swept(late_us: f64, step: usize) -> (usize, usize) {
    let close = |permille| MotorDrive::Close(Duty::per_mille(permille));
    let lasts_s = 0.4 + EACH_S * (DUTIES.len() / step) as f64;
    let plant = DUTIES.step_by(step).zip(0..).fold(Swing::new(lasts_s), |plant, (permille, n)| {
        let command = Down::Drive { drive: close(permille), hold_ms: 200 };
        plant.sending(0.3 + EACH_S * f64::from(n), command)
    });
    let run =
        run(plant.at_rest(), &Options { coupling: Some(Coupling { late_us, ..EDGE }), ..Options::default() });
    let rest = run.scans[10 * SCANS_PER_FRAME];
    let worst_of = |scan: &[u16; SCAN_LEN]| {
        scan.iter().zip(rest).take(PVDF_COUNT).map(|(code, rest)| code.abs_diff(rest)).max().unwrap_or(0)
    };
    // A period may be over before a new duty is taken.
    let worst = |drive: MotorDrive| {
        let driven = run.drives.iter().zip(&run.scans).filter(|(own, _)| **own == drive);
        driven.skip(1).map(|(_, scan)| worst_of(scan)).max()
    };
    let seen: Vec<u16> = DUTIES.step_by(step).filter_map(|permille| worst(close(permille))).collect();
    (seen.len(), seen.iter().filter(|&&worst| worst > MET).count())
}

#[test]
fn no_edge_of_the_bridge_is_in_a_films_sample_at_any_duty() {
    for (late_us, step, least, most) in [(0.0, 1, 0, 0), (1.3, 10, 50, 96)] {
        let (seen, met) = swept(late_us, step);
        assert!(seen * step > 900 && (least..=most).contains(&met), "{met} of {seen}");
    }
}
