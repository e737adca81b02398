//! Something to grasp, and what it stands on.

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{
    Damping, Duration, Instant, Kilograms, KilogramsAdded, Lever, Millimetres, Newtons, Stiffness,
};

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Object {
    /// Empty.
    pub mass_kg: Kilograms,
    /// Where the fingers take it.
    pub width_mm: Millimetres,
    /// Of pad and object together, a finger.
    pub stiffness_n_per_mm: Stiffness,
    /// Force of a finger at which it is crushed: it yields and keeps the dent.
    pub crush_n: Option<Newtons>,
    /// Force of a finger at which it breaks.
    pub break_n: Option<Newtons>,
}

/// Where its mass lies, for objects that turn about the pads.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pitch {
    /// Centre of mass beside the pads.
    pub offset_mm: Lever,
    /// Centre of mass under the pads.
    pub hang_mm: Lever,
    /// Radius of gyration about the pads.
    pub gyration_mm: Millimetres,
}

/// The table it stands on, with its mat.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Table {
    pub mat_n_per_mm: Stiffness,
    /// Damping of the mat under the empty object.
    pub damping: Damping,
}

/// Something poured in (or out).
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fill {
    pub at_s: Spanned<Instant>,
    /// How long it takes, evenly.
    pub for_s: Duration,
    /// How much altogether.
    pub add_kg: Spanned<KilogramsAdded>,
}
