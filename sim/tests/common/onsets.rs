//! Whether the ticks of a run and the evidence of its detectors say the same about when each of them began to speak.

use tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME;
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::wire::Slow;

/// The frames in which each detector began to say slip or to warn of it, by its number.
pub type Onsets = [Vec<u32>; DetectorId::COUNT];

/// The onsets in the ticks of a run whose slow frames are all there, each held against the detector's evidence.
///
/// # Panics
/// If an onset is in no frame in which its detector decided. Evidence has the last decision of a slow frame. So the onset
/// of a detector that decides once a slow frame is that frame; one that decides in every frame has decided again since, and
/// nothing may have changed after its last decision.
pub fn held_against_evidence(slows: &[Slow]) -> Onsets {
    let mut onsets = Onsets::default();
    let mut before = DetectorSet::NONE;
    for slow in slows {
        let first = slow.frame + 1 - u32::from(FRAMES_PER_SLOW_FRAME);
        // A photoelastic head that is not fitted has none; a setting says which channel it takes.
        let is_fitted = slow.evidence.iter().any(|(id, _)| *id == DetectorId::Photoelastic);
        let there = DetectorId::ALL.into_iter().filter(|id| *id != DetectorId::Photoelastic || is_fitted);
        assert!(slow.evidence.iter().map(|(id, _)| *id).eq(there), "evidence of every detector");
        for &(id, evidence) in &slow.evidence {
            let in_every_frame = evidence.decided_at == slow.frame;
            let mut was = before.contains(id);
            for (frame, tick) in (first..).zip(&slow.ticks) {
                let says = tick.said.contains(id);
                if says != was {
                    let decided = frame == evidence.decided_at || in_every_frame;
                    assert!(decided, "{id:?} changed its mind in frame {frame}: {evidence:?}");
                }
                if says && !was {
                    onsets[id as usize].push(frame);
                }
                was = says;
            }
            assert_eq!(evidence.says(), was, "{id:?} at the end of frame {}: {evidence:?}", slow.frame);
        }
        before = slow.ticks.last().map_or(DetectorSet::NONE, |tick| tick.said);
    }
    onsets
}
