//! S2: below the smallest Ft/Fn at which something began to slide.

use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::wire::Slow;
use tenax_logic::setting::SettingId;

use super::Suggestion;
use crate::quantile::not_exceeded;

/// Who hears that something slides. S2 only foresees it, and a camera's word comes late.
const HEARD_BY: DetectorSet = DetectorSet::only(DetectorId::S1)
    .or(DetectorSet::only(DetectorId::Hebbian))
    .or(DetectorSet::only(DetectorId::Photoelastic));
/// Where the ratio's peak is looked for, slow frames before and after it was heard: 0.1 s.
const AROUND: usize = 8;
/// The smallest ratio that is taken for a peak: noise at the touch is not friction.
const PEAK_MIN: f64 = 0.1;
/// Slow frames in which nothing is heard, after which the next is another slip: 0.3 s.
const APART: usize = 24;

pub fn suggest(slows: &[Slow]) -> Result<Suggestion, String> {
    let ratio = |slow: &Slow| Some(f64::from(slow.forces?.ratio_permille?) / 1e3);
    let (mut peaks, mut heard_at): (Vec<f64>, Option<usize>) = (Vec::new(), None);
    for (at, slow) in slows.iter().enumerate() {
        // Knocks are not believed; while somebody strokes, the reflex believes nothing.
        let strokes = slow.behaviour == Some(Behaviour::Stroke);
        let hears = slow.ticks.iter().any(|tick| {
            let heard = if strokes { tick.said } else { tick.believed };
            !heard.and(HEARD_BY).is_empty()
        });
        if !hears {
            continue;
        }
        let begins = heard_at.is_none_or(|last| at - last > APART);
        heard_at = Some(at);
        let around = &slows[at.saturating_sub(AROUND)..slows.len().min(at + AROUND)];
        let peak = around.iter().filter_map(ratio).fold(0.0, f64::max);
        if begins && ratio(slow).is_some() && peak >= PEAK_MIN {
            peaks.push(peak);
        }
    }
    let part = f64::from(SettingId::S2OfMuS.row().default) / 1e3;
    // One in ten may have another reason.
    let Some(peak) = not_exceeded(peaks.iter().copied(), 0.1) else {
        return Err(
            "s2-permille: nothing was heard to slide while it was held; `tenax calibrate friction` strokes a surface"
                .to_owned(),
        );
    };
    Ok(Suggestion::new(
        SettingId::S2,
        1e3 * part * peak,
        format!("slips: {}, from Ft/Fn {peak:.3} on; {part} of that", peaks.len()),
    ))
}
