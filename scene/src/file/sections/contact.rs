//! What the pads touch, and how it changes.

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{Instant, Millimetres, Milliseconds, Mu, Part, Speed, Stiffness};

/// How much of the contact is modelled (`docs/scenes.md`, which level of contact).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// Rigid Coulomb friction.
    #[default]
    L0,
    /// A patch of bristles: micro slip before macro slip.
    L1,
    /// Friction that falls with speed.
    L2,
}

/// Friction between pad and surface.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    #[serde(default)]
    pub level: Level,
    /// Static friction.
    pub mu_s: Mu,
    /// Dynamic friction, at most `mu_s`.
    pub mu_d: Spanned<Mu>,
    /// How far an object can slip before it leaves the pads.
    pub pad_length_mm: Millimetres,
    /// Distance between two ridges of the skin's grooves or of the surface's texture, whichever is coarser.
    pub pitch_mm: Millimetres,
    /// Of `l0` and `l1`: how much sliding friction rises, as a part of `mu_d`, whenever the speed grows tenfold. Then a
    /// slip can be mild: it settles at the speed whose friction carries the load.
    pub mu_per_decade: Option<Spanned<Part>>,
    /// Radius of the contact of a pad: a fingertip that is flattened already.
    #[serde(default = "Contact::default_radius_mm")]
    pub patch_radius_mm: Millimetres,
    /// Of `l1`: shear stiffness of the skin under the whole patch.
    pub skin_n_per_mm: Option<Spanned<Stiffness>>,
    /// Of `l1`: damping of the skin over its stiffness.
    pub skin_ms: Option<Spanned<Milliseconds>>,
    /// Of `l2`: the sliding speed at which 1/e of the difference between `mu_s` and `mu_d` is left.
    pub stribeck_mm_s: Option<Spanned<Speed>>,
}

impl Contact {
    /// Assumed: a thumb's width of flattened rubber.
    const fn default_radius_mm() -> Millimetres {
        Millimetres::of(5.0)
    }

    /// Shear stiffness of the skin under the whole patch.
    pub fn skin_n_per_mm(&self) -> Stiffness {
        // The finger on the friction rig has 1.9 N/mm (`scenes/rig.toml`); silicone rubber is taken as the same.
        self.skin_n_per_mm.as_ref().map_or(Stiffness::of(2.0), |skin| *skin.get_ref())
    }

    /// Damping of the skin over its stiffness.
    pub fn skin_ms(&self) -> Milliseconds {
        // Assumed: rubber that rings once.
        self.skin_ms.as_ref().map_or(Milliseconds::of(3.0), |skin| *skin.get_ref())
    }

    /// How much sliding friction rises with each decade of speed.
    pub fn mu_per_decade(&self) -> f64 {
        self.mu_per_decade.as_ref().map_or(0.0, |part| part.get_ref().get())
    }

    pub fn stribeck_mm_s(&self) -> Speed {
        // Assumed, as the strip's in `physics::stribeck`.
        self.stribeck_mm_s.as_ref().map_or(Speed::of(3.0), |speed| *speed.get_ref())
    }
}

/// A change of friction for a while: water, grease.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wet {
    pub at_s: Spanned<Instant>,
    /// When it begins to go back; never without it.
    pub until_s: Option<Spanned<Instant>>,
    pub ramp_ms: Milliseconds,
    /// Static friction while it lasts.
    pub mu_s: Mu,
    /// Dynamic friction while it lasts, at most `mu_s`.
    pub mu_d: Spanned<Mu>,
}
