//! The stories of a session: three scenes of the repository, with the session's numbers in place of theirs.

use std::ops::Range;

use anyhow::Context;
use rand::{RngExt, rngs::ChaCha8Rng};
use tenax_hal_shim::named;
use tenax_scene::{SceneFile, builtin};
use toml::{Table, Value};

use super::session::Session;

named! {
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Story {
        /// Bamshad 2023, section 3.2: balls are poured in until it slips, again and again.
        Pour = "pour",
        /// The first task of section 6: picked up, and placed back.
        Pick = "pick",
        /// Knocks, arm swing, tremor, the motor, a bad supply: nothing slips.
        Disturb = "disturb",
    }
}

/// Durations, s; in the last 3 s of the disturbances the grip changes.
const POUR_S: f64 = 26.0;
const PICK_S: f64 = 9.0;
const DISTURB_S: f64 = 13.0;
/// Noise of disturbances, times the session's: a bad supply or a motor's cable is one more disturbance, and no slip.
const NOISIER: Range<f64> = 1.0..5.0;

impl Story {
    /// The scene of this story in this session, edited. Fails if a number is none that a scene may have.
    pub fn scene_in(
        self,
        session: &Session,
        rng: &mut ChaCha8Rng,
        edit: impl FnOnce(&mut Table),
    ) -> anyhow::Result<SceneFile> {
        let name = format!("array-{}", self.name());
        let (file, text) = builtin::find(&name).with_context(|| format!("the scene {name} is not there"))?;
        let mut scene = SceneFile::table(&text, &file)?;
        // `super::operator` grips.
        scene.remove("command");
        let duration_s = match self {
            Self::Pour => {
                pour(&mut scene, rng);
                POUR_S
            }
            Self::Pick => {
                put(&mut scene, "object.mass_kg", rng.random_range(0.10..0.45));
                PICK_S
            }
            Self::Disturb => {
                disturb(&mut scene, rng);
                DISTURB_S
            }
        };
        for (place, value) in session.numbers() {
            put(&mut scene, place, value);
        }
        if self == Self::Disturb {
            put(&mut scene, "array.noise_mv", session.noise_mv * rng.random_range(NOISIER));
        }
        put(&mut scene, "array.specimen", session.specimen);
        edit(&mut scene);
        scene.insert("duration_s".to_owned(), Value::from(duration_s));
        Ok(SceneFile::parse(&scene.to_string(), &format!("{name} in {}", session.name))?)
    }
}

fn pour(scene: &mut Table, rng: &mut ChaCha8Rng) {
    put(scene, "object.mass_kg", rng.random_range(0.06..0.12));
    let (mut fills, mut at_s) = (Vec::new(), 4.0);
    while at_s < POUR_S - 3.0 {
        let for_s = rng.random_range(1.0..3.0);
        let add_kg = rng.random_range(0.05..0.13);
        fills.push(Value::Table(entry(&[("at_s", at_s), ("for_s", for_s), ("add_kg", add_kg)])));
        at_s += for_s + rng.random_range(0.3..1.5);
    }
    scene.insert("fill".to_owned(), Value::Array(fills));
}

fn disturb(scene: &mut Table, rng: &mut ChaCha8Rng) {
    put(scene, "object.mass_kg", rng.random_range(0.10..0.30));
    let over_decades =
        |rng: &mut ChaCha8Rng, low: f64, high: f64| rng.random_range(low.ln()..high.ln()).exp();
    let mut knock = |n: u32| {
        Value::Table(entry(&[
            ("at_s", 3.3 + 0.6 * f64::from(n) + rng.random_range(0.0..0.5)),
            ("peak_mv", over_decades(rng, 30.0, 300.0)),
            // Frames and tools ring from 50 Hz to 2 kHz, for 1 to 30 ms.
            ("ring_hz", over_decades(rng, 50.0, 2_000.0)),
            ("decay_ms", over_decades(rng, 1.0, 30.0)),
            ("uneven", rng.random_range(0.0..1.0)),
        ]))
    };
    let knocks = (0..5).map(&mut knock).collect();
    let mut swing = |at_s: f64, cycles: i64, rate_hz: f64, peak: Range<f64>| {
        let mut swing = entry(&[("at_s", at_s), ("rate_hz", rate_hz), ("peak_m_s2", rng.random_range(peak))]);
        swing.insert("cycles".to_owned(), Value::from(cycles));
        Value::Table(swing)
    };
    let swings = vec![swing(6.4, 3, 1.5, 1.0..6.0), swing(8.6, 12, 9.0, 0.3..1.5)];
    scene.insert("knock".to_owned(), Value::Array(knocks));
    scene.insert("swing".to_owned(), Value::Array(swings));
}

pub fn entry(keys: &[(&str, f64)]) -> Table {
    keys.iter().map(|&(key, value)| (key.to_owned(), Value::from(value))).collect()
}

fn put(scene: &mut Table, place: &str, value: impl Into<Value>) {
    let Some((section, key)) = place.split_once('.') else { return };
    let section = scene.entry(section).or_insert_with(|| Value::Table(Table::new()));
    if let Value::Table(section) = section {
        section.insert(key.to_owned(), value.into());
    }
}
