//! The level of a muscle that consents: between rest and what the wearer does.

use tenax_hal_shim::wire::Slow;
use tenax_logic::setting::SettingId;

use super::{Suggestion, seconds, usual};
use crate::quantile::not_exceeded;

/// Slow frames of rest and of contraction that are enough: two seconds and half a second.
const REST_ENOUGH: usize = 160;
const ACTIVE_ENOUGH: usize = 40;
/// A contraction stands out of rest by this factor at least.
const APART: f64 = 2.0;

pub fn suggest(slows: &[Slow]) -> Result<Suggestion, String> {
    let name = SettingId::EmgOn.row().name;
    let (mut rest, mut active) = (Vec::new(), Vec::new());
    for slow in slows {
        let (Some(flexor), Some(extensor)) = (slow.flexor_mv, slow.extensor_mv) else { continue };
        let stronger = f64::from(flexor.max(extensor));
        if slow.wearer_active {
            active.push(stronger);
        } else {
            rest.push(stronger);
        }
    }
    if rest.len() < REST_ENOUGH || active.len() < ACTIVE_ENOUGH {
        return Err(format!(
            "{name}: {:.1} s of rest and {:.1} s of contraction; 2 s and 0.5 s are enough",
            seconds(rest.len()),
            seconds(active.len())
        ));
    }
    let (median, most) = usual(&rest).unwrap_or_default();
    // How it rises and falls belongs to a contraction too: what it holds is its upper half.
    let held = not_exceeded(active, 0.7).unwrap_or_default();
    if held < APART * most.max(1.0) {
        return Err(format!(
            "{name}: contractions of {held:.0} mV do not stand out of rest, up to {most:.0} mV"
        ));
    }
    Ok(Suggestion::new(
        SettingId::EmgOn,
        (most.max(1.0) * held).sqrt(),
        format!("rest {median:.0} mV, up to {most:.0} mV usual; contractions {held:.0} mV; between both"),
    ))
}
