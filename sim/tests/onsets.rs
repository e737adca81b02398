//! What a run reports of a detector's onset is the frame in which its evidence says that it decided.

use crate::common::onsets::held_against_evidence;
use tenax_hal_shim::detector::DetectorId;
use tenax_sim::board::{Recorder, Run};
use tenax_sim::live::Use;
use tenax_sim::session::{self, Board};
use tenax_sim::timeline::Timeline;

#[test]
fn every_onset_of_a_scene_is_where_its_evidence_says() {
    // S1 and S2; the MLP.
    for (scene, speaks) in [
        (session::DEFAULT_SCENE, vec![DetectorId::S1, DetectorId::S2]),
        ("array-pick", vec![DetectorId::Mlp]),
    ] {
        let file = session::load_scene(scene).unwrap();
        let mut run = Run::default();
        let outcome =
            session::scene_served(&file, 1, &Board::Host, Use::default(), &mut run, &mut |_| {}).unwrap();
        let mut timeline = Timeline::new(0.0);
        run.slows.iter().for_each(|slow| timeline.slow(slow));
        let onsets = held_against_evidence(&run.slows);
        for id in DetectorId::ALL {
            let decided_s: Vec<f64> =
                onsets[id as usize].iter().map(|&frame| timeline.time_s(frame)).collect();
            assert_eq!(timeline.said(id), decided_s, "{scene}: {id:?}");
            assert_eq!(outcome.report.detectors.of_id(id).said, decided_s.len(), "{scene}: {id:?}");
            assert!(!decided_s.is_empty() || !speaks.contains(&id), "{scene}: {id:?} said nothing");
        }
    }
}
