//! The friction of the pads on the surface, and how water changes it.

use crate::file::sections::{Contact, Wet};
use crate::schedule::{Span, smooth};

/// Coulomb's two coefficients at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    pub mu_s: f64,
    /// Dynamic: shear over normal force while it slides. At most `mu_s`.
    pub mu_d: f64,
}

/// Slower than this, sliding friction does not depend on speed, m/s (assumed).
const SLOWEST_M_S: f64 = 1e-3;

impl Friction {
    /// Rise of `mu_d` at `speed_m_s` where friction rises by `per_decade` of it with each tenfold speed:
    /// `mu_d k log10(1 + v / v_0)`, as rubber's does below its peak (Grosch 1963; that it is a straight line over the
    /// logarithm is assumed).
    pub fn rise(self, per_decade: f64, speed_m_s: f64) -> f64 {
        self.mu_d * per_decade * libm::log10(1.0 + speed_m_s / SLOWEST_M_S)
    }

    pub fn rise_s_per_m(self, per_decade: f64, speed_m_s: f64) -> f64 {
        // Below a thousandth of the slowest the quotient is the slope to four places.
        let speed_m_s = speed_m_s.max(1e-3 * SLOWEST_M_S);
        self.rise(per_decade, speed_m_s) / speed_m_s
    }
}

/// Time to wet or dry a surface, s (assumed).
const WETS_S: f64 = 0.02;

#[derive(Clone, Debug)]
pub struct Surface {
    dry: Friction,
    patches: Vec<Patch>,
}

#[derive(Clone, Debug)]
struct Patch {
    wetting: Span,
    drying: Span,
    friction: Friction,
}

impl Surface {
    pub(crate) fn new(contact: &Contact, wet: &[Wet]) -> Self {
        let patches = wet.iter().map(|wet| {
            let ramp_s = wet.ramp_ms.get() / 1e3;
            Patch {
                wetting: Span::new(wet.at_s.get(), ramp_s),
                drying: Span::new(wet.until_s.as_ref().map_or(f64::INFINITY, |s| s.get()), ramp_s),
                friction: Friction { mu_s: wet.mu_s.get(), mu_d: wet.mu_d.get_ref().get() },
            }
        });
        Self {
            dry: Friction { mu_s: contact.mu_s.get(), mu_d: contact.mu_d.get_ref().get() },
            patches: patches.collect(),
        }
    }

    pub(crate) fn wet(&mut self, t_s: f64) {
        let dried = Span::new(t_s, WETS_S);
        if let Some(patch) = self.patches.iter_mut().find(|patch| patch.drying.begin_s > t_s) {
            patch.drying = dried;
            return;
        }
        let Friction { mu_s, mu_d } = self.dry;
        let friction = Friction { mu_s: mu_s / 2.0, mu_d: mu_d / 2.0 };
        let drying = Span { begin_s: f64::INFINITY, end_s: f64::INFINITY };
        self.patches.push(Patch { wetting: dried, drying, friction });
    }

    pub fn at(&self, t_s: f64) -> Friction {
        self.patches.iter().filter(|patch| t_s >= patch.wetting.begin_s).fold(self.dry, |dry, patch| {
            let part = smooth(patch.wetting.progress(t_s)) * (1.0 - patch.dried(t_s));
            let mix = |dry: f64, wet: f64| dry + part * (wet - dry);
            Friction { mu_s: mix(dry.mu_s, patch.friction.mu_s), mu_d: mix(dry.mu_d, patch.friction.mu_d) }
        })
    }
}

impl Patch {
    fn dried(&self, t_s: f64) -> f64 {
        if t_s < self.drying.begin_s { 0.0 } else { smooth(self.drying.progress(t_s)) }
    }
}
