//! The evidence of a detector names the frame in which it decided: that of its onset.

use tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME;
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_scene::World;
use tenax_sim::board::simulated;
use tenax_sim::session::DEFAULT_SCENE;

use crate::common::loaded;

#[test]
fn every_onset_of_a_scene_is_where_its_evidence_says() {
    for (scene, speak) in
        [(DEFAULT_SCENE, &[DetectorId::S1, DetectorId::S2][..]), ("array-pick", &[DetectorId::Mlp])]
    {
        let (run, _) = simulated::run(World::new(&loaded(scene), 1));
        let (mut before, mut spoke) = (DetectorSet::NONE, DetectorSet::NONE);
        for slow in &run.slows {
            let first = slow.frame + 1 - u32::from(FRAMES_PER_SLOW_FRAME);
            for &(id, evidence) in &slow.evidence {
                // One that decides in every frame has decided again since: evidence has the last decision of a slow frame.
                let in_every_frame = evidence.decided_at == slow.frame;
                let mut was = before.contains(id);
                for (frame, tick) in (first..).zip(&slow.ticks) {
                    let says = tick.said.contains(id);
                    let decided = in_every_frame || frame == evidence.decided_at;
                    assert!(says == was || decided, "{scene}: {id:?} in frame {frame}: {evidence:?}");
                    spoke = spoke.with(id, says || spoke.contains(id));
                    was = says;
                }
                assert_eq!(evidence.says(), was, "{scene}: {id:?} after frame {}: {evidence:?}", slow.frame);
            }
            before = slow.ticks.last().map_or(DetectorSet::NONE, |tick| tick.said);
        }
        assert!(speak.iter().all(|id| spoke.contains(*id)), "{scene}: {spoke:?}");
    }
}
