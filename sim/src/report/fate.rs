//! What really happened in a scene, as far as the scores need it.

use tenax_scene::{SceneFile, Truth};

use super::added::Grips;
use crate::scorer::{SlipSpan, Stretch, doing};

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fate {
    pub slips: Vec<SlipSpan>,
    pub doing: Vec<Stretch>,
    /// How far the object slid altogether when it was not meant to, mm.
    pub distance_mm: f64,
    pub dropped: bool,
    pub left_behind: bool,
    pub handed_over: bool,
    pub turned_rad: f64,
    /// The greatest grip force, N. None where nothing was held.
    pub peak_grip_n: Option<f64>,
    pub carried_s: f64,
    /// The mean grip force while the hand carried it, N. None if it never did.
    pub mean_grip_n: Option<f64>,
    pub crushed_at_s: Option<f64>,
    pub dent_mm: f64,
    pub broken_at_s: Option<f64>,
    pub needed_force_n: Option<f64>,
    /// The mean of the grip force beyond the need while the hand carried it, N.
    pub beyond_need_n: Option<f64>,
    pub margin_n: Option<[f64; 2]>,
    pub grips: Grips,
}

impl Fate {
    pub fn of(truth: &Truth, scene: &SceneFile) -> Self {
        let held = truth.needed_grip_n > 0.0;
        Self {
            slips: spans(truth),
            doing: doing::in_scene(scene),
            distance_mm: truth.slip_distance_mm,
            dropped: truth.dropped,
            left_behind: truth.left_behind,
            handed_over: truth.handed_over,
            turned_rad: truth.turned_rad,
            crushed_at_s: truth.crushed_at_s,
            dent_mm: truth.dent_mm,
            broken_at_s: truth.broken_at_s,
            carried_s: truth.carried_s,
            mean_grip_n: (truth.carried_s > 0.0).then(|| truth.carried_ns / truth.carried_s),
            peak_grip_n: (truth.peak_grip_n > 0.0).then_some(truth.peak_grip_n),
            needed_force_n: held.then_some(truth.needed_grip_n),
            beyond_need_n: (truth.carried_s > 0.0).then(|| truth.beyond_need_ns / truth.carried_s),
            margin_n: truth.margin_n,
            grips: Grips::default(),
        }
    }

    pub const fn kept(&self) -> bool {
        !self.dropped && !self.left_behind && self.broken_at_s.is_none()
    }
}

pub fn spans(truth: &Truth) -> Vec<SlipSpan> {
    let slips = truth.slips.iter().map(|slip| SlipSpan {
        micro_onset_s: slip.micro_onset_s,
        macro_onset_s: Some(slip.macro_onset_s),
        end_s: slip.end_s.unwrap_or(f64::INFINITY),
        distance_mm: slip.distance_mm,
        meant: slip.meant,
    });
    let runs = truth.micro_runs.iter().map(|run| SlipSpan {
        micro_onset_s: run.begin_s,
        macro_onset_s: None,
        end_s: run.end_s,
        distance_mm: 0.0,
        meant: false,
    });
    let mut all: Vec<SlipSpan> = slips.chain(runs).collect();
    all.sort_by(|a, b| a.micro_onset_s.total_cmp(&b.micro_onset_s));
    all
}
