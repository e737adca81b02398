//! Sessions: a box, an array and a gripper as somebody set them up on one day. No two are alike.

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use serde::Serialize;

use tenax_sim::array::material::{Ends, HELD_OUT, Material, SEEN};
use tenax_sim::labelled::Part;

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

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Session {
    pub name: String,
    pub split: Part,
    pub material: &'static str,
    pub seed: u64,
    pub specimen: u32,
    pub mu_s: f64,
    pub mu_d: f64,
    /// Rise of dynamic friction with each decade of speed, as a part.
    pub mu_per_decade: f64,
    /// Pitch of the texture, mm.
    pub pitch_mm: f64,
    /// Unevenness, as a part of an element's load.
    pub uneven: f64,
    /// Stiffness of cover and wall, a finger, N/mm.
    pub stiffness_n_per_mm: f64,
    /// The way over which contacts are new ones, um.
    pub renews_um: f64,
    /// Part of the released shear that comes off an element's load.
    pub slip_part: f64,
    /// The part of it that goes to the cover's rim.
    pub rim_part: f64,
    /// Place of the box along the array, mm from its middle.
    pub place_mm: f64,
    /// Offset of the box's mass beside the pads, mm.
    pub offset_mm: f64,
    /// Offset below them, mm.
    pub hang_mm: f64,
    /// Sensitivity of the array, mV/N an element.
    pub mv_per_n: f64,
    pub spread: f64,
    /// Noise of a reading, rms, mV.
    pub noise_mv: f64,
    /// Force of a knock on the pad, mN for each mV at a film.
    pub knock_mn_per_mv: f64,
    /// Force of the gear's teeth on it, as a part of the load.
    pub motor_part: f64,
    /// Part of the load that a shear as large as it moves to the pad's end.
    pub tilt: f64,
}

impl Session {
    fn draw(name: String, split: Part, material: &Material, rng: &mut ChaCha8Rng) -> Self {
        let seed = rng.random();
        let specimen = rng.random();
        let mut evenly = |low: f64, high: f64| rounded(rng.random_range(low..high));
        let (place_mm, offset_mm, hang_mm) = (evenly(-3.0, 3.0), evenly(-12.0, 12.0), evenly(6.0, 20.0));
        // As often in one tenth of a decade as in another: nobody knows more than the ends.
        let mut drawn =
            |[low, high]: Ends| rounded((low.ln() + (high / low).ln() * rng.random_range(0.0..1.0)).exp());
        let contact = &material.contact;
        let mu_s = drawn(material.mu_s);
        Self {
            mu_s,
            mu_d: rounded(mu_s * drawn(material.mu_ratio)),
            mu_per_decade: drawn(material.mu_per_decade),
            pitch_mm: drawn(material.pitch_mm),
            uneven: drawn(material.uneven),
            stiffness_n_per_mm: drawn(material.stiffness_n_per_mm),
            renews_um: drawn(contact.renews_um),
            slip_part: drawn(contact.slip_part),
            rim_part: drawn(contact.rim_part),
            place_mm,
            offset_mm,
            hang_mm,
            mv_per_n: drawn(contact.mv_per_n),
            spread: drawn(contact.spread),
            noise_mv: drawn(contact.noise_mv),
            knock_mn_per_mv: drawn(contact.knock_mn_per_mv),
            motor_part: drawn(contact.motor_part),
            // Last: a field's draw depends on those before it.
            tilt: drawn(contact.tilt),
            name,
            split,
            material: material.name,
            seed,
            specimen,
        }
    }
}

/// To four places: what the manifest says is what was run.
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
