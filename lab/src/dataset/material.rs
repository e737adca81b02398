//! What the boxes' sides are made of: Bamshad 2023 (section 3.2) takes four materials and gives no number of any.
//!
//! Nobody has measured these surfaces under this cover, so each has ranges and no values, and a session draws from them. The
//! ends are from texts where a text has them: skin and rubber on solids have friction of 0.2 to 1.2, the more the smoother and
//! drier (Derler and Gerhardt 2012, a review); Ft/Fn on raw wood peaks at about 0.5 (Prosthesis, section 5); sliding keeps 0.6
//! to 0.95 of it (the recorded rig: 0.65). The rest is assumed.

use serde::Serialize;

pub type Ends = [f64; 2];

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Material {
    pub name: &'static str,
    pub mu_s: Ends,
    pub mu_ratio: Ends,
    pub mu_per_decade: Ends,
    /// Pitch of its texture or of the cover's grooves, the coarser, mm.
    pub pitch_mm: Ends,
    pub uneven: Ends,
    /// Stiffness of cover and wall together, a finger, N/mm.
    pub stiffness_n_per_mm: Ends,
    pub contact: Contact,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Contact {
    /// Slip that renews all contacts under an element, um: single ones are some to some tens wide (Dieterich and Kilgore 1994).
    pub renews_um: Ends,
    pub slip_part: Ends,
    pub rim_part: Ends,
    /// Sensitivity of the array, mV/N: 14.7 N over 3 V is 200 (Bamshad 2023, section 2.1); a skin spreads the load.
    pub mv_per_n: Ends,
    pub spread: Ends,
    /// Noise of a reading, mV: a tenth of the converter's step to a real BioTac's (3 counts, 2.4 mV here).
    pub noise_mv: Ends,
    /// What a knock presses on the pad, mN for each mV at a film.
    pub knock_mn_per_mv: Ends,
    pub motor_part: Ends,
    pub tilt: Ends,
}

const DECADES: Contact = Contact {
    renews_um: [10.0, 100.0],
    slip_part: [0.05, 0.5],
    rim_part: [0.08, 0.8],
    mv_per_n: [50.0, 500.0],
    spread: [0.05, 0.5],
    noise_mv: [0.2, 2.0],
    knock_mn_per_mv: [0.3, 3.0],
    motor_part: [0.001, 0.01],
    tilt: [0.08, 0.8],
};

const fn seen(name: &'static str, mu_s: Ends, mu_ratio: Ends, pitch_mm: Ends, uneven: Ends) -> Material {
    let (mu_per_decade, stiffness_n_per_mm) = ([0.02, 0.10], [2.0, 8.0]);
    Material { name, mu_s, mu_ratio, mu_per_decade, pitch_mm, uneven, stiffness_n_per_mm, contact: DECADES }
}

/// The four that a detector may learn from.
pub const SEEN: [Material; 4] = [
    // A drawn wall: it slides evenly, and the cover's own grooves are its texture.
    seen("plastic", [0.30, 1.0], [0.75, 0.95], [0.2, 1.2], [0.006, 0.03]),
    // Fibres: it lets go with a jerk. A wall of paper gives.
    Material {
        stiffness_n_per_mm: [1.5, 4.0],
        ..seen("paper", [0.25, 0.8], [0.70, 0.92], [0.2, 0.8], [0.01, 0.05])
    },
    // Ra 0.8 um: smooth and hard, and the one that Bamshad's detector was weakest on (figure 9).
    Material {
        stiffness_n_per_mm: [5.0, 15.0],
        ..seen("aluminium", [0.25, 0.9], [0.75, 0.95], [0.2, 0.6], [0.006, 0.02])
    },
    // Grain.
    Material {
        stiffness_n_per_mm: [3.0, 12.0],
        ..seen("wood", [0.30, 1.1], [0.66, 0.90], [0.5, 2.0], [0.02, 0.06])
    },
];

pub const HELD_OUT: Material = Material {
    name: "rubber",
    mu_s: [1.12, 1.2],
    mu_ratio: [0.60, 0.64],
    mu_per_decade: [0.11, 0.14],
    pitch_mm: [2.2, 3.0],
    uneven: [0.065, 0.09],
    stiffness_n_per_mm: [1.0, 1.4],
    contact: Contact {
        renews_um: [110.0, 200.0],
        slip_part: [0.55, 0.8],
        rim_part: [0.85, 0.95],
        mv_per_n: [35.0, 48.0],
        spread: [0.55, 0.6],
        noise_mv: [2.2, 3.0],
        knock_mn_per_mv: [3.2, 4.0],
        motor_part: [0.011, 0.015],
        tilt: [0.85, 0.95],
    },
};

#[cfg(test)]
mod tests {
    use serde::Deserialize;
    use serde_json::Value;

    use super::*;

    fn ranges(material: &impl Serialize) -> Vec<Ends> {
        fn all(value: &Value) -> Vec<Ends> {
            match value {
                Value::Object(fields) => fields.values().flat_map(all).collect(),
                ends => Ends::deserialize(ends).into_iter().collect(),
            }
        }
        all(&serde_json::to_value(material).unwrap())
    }

    #[test]
    fn the_one_that_is_held_out_is_outside_the_hull_of_the_others_in_everything() {
        assert_eq!(ranges(&HELD_OUT).len(), 15);
        for (n, own) in ranges(&HELD_OUT).into_iter().enumerate() {
            let others = SEEN.map(|material| ranges(&material)[n]);
            let low = others.iter().map(|ends| ends[0]).fold(f64::INFINITY, f64::min);
            let high = others.iter().map(|ends| ends[1]).fold(0.0, f64::max);
            assert!(own[1] < low || own[0] > high, "quantity {n}: {own:?} in {low} to {high}");
        }
    }
}
