//! Something to grasp, and what it stands on.

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{
    Damping, Duration, Instant, Kilograms, KilogramsAdded, Lever, Millimetres, Newtons, Stiffness,
};

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Object {
    pub mass_kg: Kilograms,
    pub width_mm: Millimetres,
    pub stiffness_n_per_mm: Stiffness,
    pub crush_n: Option<Newtons>,
    pub break_n: Option<Newtons>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pitch {
    pub offset_mm: Lever,
    pub hang_mm: Lever,
    pub gyration_mm: Millimetres,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Table {
    pub mat_n_per_mm: Stiffness,
    pub damping: Damping,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fill {
    pub at_s: Spanned<Instant>,
    pub for_s: Duration,
    pub add_kg: Spanned<KilogramsAdded>,
}
