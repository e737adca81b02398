//! What the pads touch, and how it changes.

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{Instant, Millimetres, Milliseconds, Mu, Part, Speed, Stiffness};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// Rigid Coulomb friction.
    #[default]
    L0,
    L1,
    L2,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    #[serde(default)]
    pub level: Level,
    pub mu_s: Mu,
    /// Dynamic friction, at most `mu_s`.
    pub mu_d: Spanned<Mu>,
    pub pad_length_mm: Millimetres,
    pub pitch_mm: Millimetres,
    pub mu_per_decade: Option<Spanned<Part>>,
    #[serde(default = "Contact::default_radius_mm")]
    pub patch_radius_mm: Millimetres,
    pub skin_n_per_mm: Option<Spanned<Stiffness>>,
    pub skin_ms: Option<Spanned<Milliseconds>>,
    pub stribeck_mm_s: Option<Spanned<Speed>>,
}

impl Contact {
    /// Assumed: a thumb's width of flattened rubber.
    const fn default_radius_mm() -> Millimetres {
        Millimetres::of(5.0)
    }

    pub fn skin_n_per_mm(&self) -> Stiffness {
        // The finger on the friction rig has 1.9 N/mm (`scenes/rig.toml`); silicone rubber is taken as the same.
        self.skin_n_per_mm.as_ref().map_or(Stiffness::of(2.0), |skin| *skin.get_ref())
    }

    pub fn skin_ms(&self) -> Milliseconds {
        // Assumed: rubber that rings once.
        self.skin_ms.as_ref().map_or(Milliseconds::of(3.0), |skin| *skin.get_ref())
    }

    pub fn mu_per_decade(&self) -> f64 {
        self.mu_per_decade.as_ref().map_or(0.0, |part| part.get_ref().get())
    }

    pub fn stribeck_mm_s(&self) -> Speed {
        // Assumed, as the strip's in `physics::stribeck`.
        self.stribeck_mm_s.as_ref().map_or(Speed::of(3.0), |speed| *speed.get_ref())
    }
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wet {
    pub at_s: Spanned<Instant>,
    pub until_s: Option<Spanned<Instant>>,
    pub ramp_ms: Milliseconds,
    pub mu_s: Mu,
    /// Dynamic friction while it lasts, at most `mu_s`.
    pub mu_d: Spanned<Mu>,
}
