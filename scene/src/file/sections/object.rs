//! Something to grasp, and what it stands on.

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{Damping, Duration, Instant, Kilograms, KilogramsAdded, Millimetres, Stiffness};

/// Something to grasp.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Object {
    /// Empty.
    pub mass_kg: Kilograms,
    /// Where the fingers take it.
    pub width_mm: Millimetres,
    /// Of pad and object together, a finger.
    pub stiffness_n_per_mm: Stiffness,
}

/// The table it stands on, with its mat.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Table {
    /// Stiffness of the mat.
    pub mat_n_per_mm: Stiffness,
    /// Damping of the mat under the empty object.
    pub damping: Damping,
}

/// Something poured in (or out).
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fill {
    /// When it begins.
    pub at_s: Spanned<Instant>,
    /// How long it takes, evenly.
    pub for_s: Duration,
    /// How much altogether.
    pub add_kg: Spanned<KilogramsAdded>,
}
