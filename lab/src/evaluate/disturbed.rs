//! `tenax evaluate disturbed`: hours of everyday disturbance in hands, objects and noise that are drawn anew for each hold.

use rayon::prelude::*;
use serde::Serialize;
use serde_json::{Map, Value};
use tenax_hal_shim::detector::DetectorId;
use tenax_scene::drawn::Drawn;
use tenax_sim::jobs::{Jobs, Told};
use tenax_sim::live::Use;
use tenax_sim::report::scores::Detectors;
use tenax_sim::session::{self, Board};

use crate::chart::table::scored::{Between, a_unit};

/// Length of a hold.
pub const MINUTES: u32 = 10;
const HEARD: [DetectorId; 4] = [DetectorId::S1, DetectorId::S2, DetectorId::Hebbian, DetectorId::Mlp];

/// One hold.
struct Hold {
    carried_h: f64,
    lost: bool,
    slips: usize,
    closings: usize,
    without_need: u32,
    without_need_n: f64,
    detectors: Detectors,
}

/// A figure that is followed by two has the ends between which it lies with 95 %, as a Poisson count.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub seed: u64,
    pub holds: u32,
    /// Hours in which the object was carried.
    pub hours: f64,
    pub lost: usize,
    /// Slips of more than a ring of the pad.
    pub slips: usize,
    pub closings: usize,
    /// Closings that added more than 0.1 N without need; they and their newtons in 24 h of holding.
    pub without_need: u32,
    pub without_need_a_day: Between,
    pub without_need_n_a_day: f64,
    /// Believed reports and warnings outside every slip, an hour.
    pub false_an_hour: Map<String, Value>,
}

/// Runs holds of ten minutes on the host. Fails if a range leads out of what a scene file may say.
pub fn evaluate(seed: u64, holds: u32, told: Told<'_>) -> anyhow::Result<Report> {
    let jobs = Jobs::new(holds as usize, told);
    let one = |index| -> anyhow::Result<Hold> {
        let _job = jobs.begin();
        let drawn = Drawn::hold(seed, index, MINUTES);
        let (file, line) = (drawn.scene()?, Use { without_bound: true, ..Use::default() });
        let outcome =
            session::scene_served(&file, drawn.noise_seed, &Board::Host, line, &mut (), &mut |_| {})?;
        let (report, truth) = (outcome.report, outcome.truth);
        Ok(Hold {
            carried_h: truth.carried_s / 3_600.0,
            lost: !truth.kept(),
            slips: report.slip.macro_slips.unwrap_or_default(),
            closings: report.reflex.pulses,
            without_need: report.added.closings_without_need.unwrap_or_default(),
            without_need_n: report.added.added_without_need_n.unwrap_or_default(),
            detectors: report.detectors,
        })
    };
    let all: Vec<Hold> =
        (0..holds).into_par_iter().with_max_len(1).map(one).collect::<anyhow::Result<_>>()?;
    let hours: f64 = all.iter().map(|hold| hold.carried_h).sum();
    let without_need = all.iter().map(|hold| hold.without_need).sum();
    let alarms = |id| {
        let own = |hold: &Hold| hold.detectors.of_id(id).false_alarms.unwrap_or_default();
        (id.name().to_owned(), a_unit(all.iter().map(own).sum::<usize>() as f64, hours).as_slice().into())
    };
    Ok(Report {
        seed,
        holds,
        hours,
        lost: all.iter().filter(|hold| hold.lost).count(),
        slips: all.iter().map(|hold| hold.slips).sum(),
        closings: all.iter().map(|hold| hold.closings).sum(),
        without_need,
        without_need_a_day: a_unit(f64::from(without_need), hours / 24.0),
        without_need_n_a_day: 24.0 / hours * all.iter().map(|hold| hold.without_need_n).sum::<f64>(),
        false_an_hour: HEARD.into_iter().map(alarms).collect(),
    })
}
