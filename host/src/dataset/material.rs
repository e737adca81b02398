//! What the boxes' sides are made of: Bamshad 2023 (section 3.2) takes four materials and gives no number of any.

use serde::Serialize;

/// One material under the array's silicone cover.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Material {
    /// What it is called in the data.
    pub name: &'static str,
    /// Static friction.
    pub mu_s: f64,
    /// Dynamic friction of slow sliding.
    pub mu_d: f64,
    /// How much that rises with each decade of speed, as a part.
    pub mu_per_decade: f64,
    /// Pitch of its texture or of the cover's grooves, the coarser, mm.
    pub pitch_mm: f64,
    /// Unevenness, as a part of an element's load.
    pub uneven: f64,
    /// Stiffness of cover and wall together, a finger, N/mm.
    pub stiffness_n_per_mm: f64,
}

/// The four that a detector may learn from. Assumed, but for wood's `mu_s`.
pub const SEEN: [Material; 4] = [
    // A drawn wall: it slides evenly, and the cover's own grooves are its texture.
    Material {
        name: "plastic",
        mu_s: 0.60,
        mu_d: 0.54,
        mu_per_decade: 0.08,
        pitch_mm: 0.8,
        uneven: 0.03,
        stiffness_n_per_mm: 4.0,
    },
    // Fibres: it lets go with a jerk. A wall of paper gives.
    Material {
        name: "paper",
        mu_s: 0.55,
        mu_d: 0.48,
        mu_per_decade: 0.06,
        pitch_mm: 0.4,
        uneven: 0.04,
        stiffness_n_per_mm: 2.0,
    },
    // Ra 0.8 um: smooth, hard and slippery, and the one that Bamshad's detector was weakest on (figure 9).
    Material {
        name: "aluminium",
        mu_s: 0.42,
        mu_d: 0.39,
        mu_per_decade: 0.07,
        pitch_mm: 0.3,
        uneven: 0.015,
        stiffness_n_per_mm: 8.0,
    },
    // Prosthesis, section 5: Ft/Fn peaks at about 0.5 on raw wood. Grain.
    Material {
        name: "wood",
        mu_s: 0.50,
        mu_d: 0.43,
        mu_per_decade: 0.05,
        pitch_mm: 1.0,
        uneven: 0.06,
        stiffness_n_per_mm: 6.0,
    },
];

/// The one that no detector sees before it is tested: between the others in everything. Assumed.
pub const HELD_OUT: Material = Material {
    name: "cardboard",
    mu_s: 0.46,
    mu_d: 0.40,
    mu_per_decade: 0.06,
    pitch_mm: 0.6,
    uneven: 0.045,
    stiffness_n_per_mm: 2.5,
};
