//! Sessions: a box, an array and a gripper as somebody set them up on one day.

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use serde::Serialize;
use tenax_hal_shim::named;

use super::material::{Ends, HELD_OUT, Material, SEEN};

named! {
    /// Part of a data set that a session belongs to.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Part {
        Train = "train",
        Validation = "validation",
        Test = "test",
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// To learn from, of each seen material.
    pub train: usize,
    pub validation: usize,
    /// To judge by, of each seen material; the material that is held out has as many again.
    pub test: usize,
}

impl Sizes {
    /// The default. The network that ships learned from four times as many.
    pub const DEFAULT_TRAIN: usize = 24;

    /// In proportion to those to learn from.
    pub const fn of_train(train: usize) -> Self {
        Self { train, validation: train.div_ceil(4), test: train.div_ceil(2) }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    pub name: String,
    pub split: Part,
    pub material: &'static str,
    pub seed: u64,
    pub specimen: u32,
    pub mu_s: f64,
    pub mu_d: f64,
    /// Stiffness of cover and wall, a finger, N/mm.
    pub stiffness_n_per_mm: f64,
    /// Noise of a reading, rms, mV.
    pub noise_mv: f64,
    pub others: Vec<Number>,
}

/// `section.key` of a scene file, and its value.
pub type Number = (&'static str, f64);

impl Session {
    /// A field's draw depends on those before it: a new one is drawn last.
    fn draw(name: String, split: Part, material: &Material, rng: &mut ChaCha8Rng) -> Self {
        let seed = rng.random();
        let specimen = rng.random();
        // Place of the box along the array; offset of its mass beside the pads, and below them.
        let mut others =
            [("array.place_mm", -3.0..3.0), ("pitch.offset_mm", -12.0..12.0), ("pitch.hang_mm", 6.0..20.0)]
                .map(|(place, ends)| (place, rounded(rng.random_range(ends))))
                .to_vec();
        // As often in one tenth of a decade as in another: nobody knows more than the ends.
        let mut drawn =
            |[low, high]: Ends| rounded((low.ln() + (high / low).ln() * rng.random_range(0.0..1.0)).exp());
        let contact = &material.contact;
        let mu_s = drawn(material.mu_s);
        let mu_d = rounded(mu_s * drawn(material.mu_ratio));
        others.push(("contact.mu_per_decade", drawn(material.mu_per_decade)));
        others.push(("contact.pitch_mm", drawn(material.pitch_mm)));
        others.push(("array.uneven", drawn(material.uneven)));
        let stiffness_n_per_mm = drawn(material.stiffness_n_per_mm);
        others.push(("array.renews_um", drawn(contact.renews_um)));
        others.push(("array.slip_part", drawn(contact.slip_part)));
        others.push(("array.rim_part", drawn(contact.rim_part)));
        others.push(("array.mv_per_n", drawn(contact.mv_per_n)));
        others.push(("array.spread", drawn(contact.spread)));
        let noise_mv = drawn(contact.noise_mv);
        others.push(("array.knock_mn_per_mv", drawn(contact.knock_mn_per_mv)));
        others.push(("array.motor_part", drawn(contact.motor_part)));
        others.push(("array.tilt", drawn(contact.tilt)));
        let material = material.name;
        Self { name, split, material, seed, specimen, mu_s, mu_d, stiffness_n_per_mm, noise_mv, others }
    }

    pub fn numbers(&self) -> impl Iterator<Item = Number> {
        let own = [
            ("contact.mu_s", self.mu_s),
            ("contact.mu_d", self.mu_d),
            ("object.stiffness_n_per_mm", self.stiffness_n_per_mm),
            ("array.noise_mv", self.noise_mv),
        ];
        own.into_iter().chain(self.others.iter().copied())
    }
}

/// To four places.
fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// All sessions of a data set, the same for the same seed. Each draws from a stream of its own material, split and number:
/// a larger data set has all sessions of a smaller one, in the same split.
pub fn sessions(seed: u64, sizes: Sizes) -> Vec<Session> {
    let Sizes { train, validation, test } = sizes;
    let seen = [(Part::Train, train), (Part::Validation, validation), (Part::Test, test)];
    let held_out = [(Part::Test, 2 * test)];
    let materials = SEEN.iter().map(|material| (material, &seen[..])).chain([(&HELD_OUT, &held_out[..])]);
    let mut all = Vec::new();
    for (index, (material, splits)) in materials.enumerate() {
        for (split, number) in splits.iter().flat_map(|&(split, count)| (1..=count).map(move |n| (split, n)))
        {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            rng.set_stream(((index as u64) << 40) | ((split as u64) << 32) | number as u64);
            let name = format!("{}-{}-{number:02}", material.name, split.name());
            all.push(Session::draw(name, split, material, &mut rng));
        }
    }
    all
}
