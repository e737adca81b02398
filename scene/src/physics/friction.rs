//! The friction of the pads on the surface, and how water changes it.

use crate::file::sections::{Contact, Wet};
use crate::schedule::{Span, smooth};

/// Coulomb's two coefficients at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Static: shear over normal force at which it begins to slide.
    pub mu_s: f64,
    /// Dynamic: shear over normal force while it slides. At most `mu_s`.
    pub mu_d: f64,
}

/// Friction over time: dry, with wet patches.
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
                wetting: Span::new(wet.at_s.get_ref().get(), ramp_s),
                drying: Span::new(wet.until_s.as_ref().map_or(f64::INFINITY, |s| s.get_ref().get()), ramp_s),
                friction: Friction { mu_s: wet.mu_s.get(), mu_d: wet.mu_d.get_ref().get() },
            }
        });
        Self {
            dry: Friction { mu_s: contact.mu_s.get(), mu_d: contact.mu_d.get_ref().get() },
            patches: patches.collect(),
        }
    }

    /// The coefficients at `t_s`.
    #[must_use]
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
