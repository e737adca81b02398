//! What the pads touch, and how it changes.

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{Instant, Millimetres, Milliseconds, Mu};

/// Friction between pad and surface.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Static friction.
    pub mu_s: Mu,
    /// Dynamic friction, at most `mu_s`.
    pub mu_d: Spanned<Mu>,
    /// How far an object can slip before it leaves the pads.
    pub pad_length_mm: Millimetres,
    /// Distance between two ridges of the skin's grooves or of the surface's texture, whichever is coarser.
    pub pitch_mm: Millimetres,
}

/// A change of friction for a while: water, grease.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wet {
    /// When it begins.
    pub at_s: Spanned<Instant>,
    /// When it begins to go back; never without it.
    pub until_s: Option<Spanned<Instant>>,
    /// How long each change takes.
    pub ramp_ms: Milliseconds,
    /// Static friction while it lasts.
    pub mu_s: Mu,
    /// Dynamic friction while it lasts, at most `mu_s`.
    pub mu_d: Spanned<Mu>,
}
