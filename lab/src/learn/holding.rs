//! Holding: minutes in which nothing slips, and much else happens.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use tenax_scene::{SceneFile, Seeds, World};

use super::bench::{Bench, Judge};
use super::finger::Finger;
use super::trial::Word;
use crate::dataset::story::entry;
use tenax_sim::report::fate;
use tenax_sim::scorer::{Alarms, Card, Doing, Stretch};

const SCENE: &str = "hold";
/// The block is in the air and the hand still, s.
pub const FROM_S: f64 = 4.0;
const KNOCKS: u32 = 6;
const SWINGS: u32 = 2;
const RUNS: u32 = 2;

/// False alarms of slip, and of a warning.
#[derive(Clone, Copy, Debug)]
pub struct Holding {
    pub slip: Alarms,
    pub warning: Alarms,
}

/// So many minutes with this fingertip, each by itself. `done` is told when one is over. Fails if a scene cannot be made.
pub fn hold(
    finger: &Finger,
    learned: &Bench,
    minutes: u64,
    seed: u64,
    done: &(dyn Fn() + Sync),
) -> anyhow::Result<Holding> {
    let all = (0..minutes).into_par_iter().map(|n| {
        let minute = one(finger, learned, seed + n);
        done();
        minute
    });
    let cards = all.try_reduce(<[Card; 2]>::default, |mut sum, minute| {
        sum.iter_mut().zip(&minute).for_each(|(sum, card)| sum.add(card));
        Ok(sum)
    })?;
    let [slip, warning] = cards.map(|card| card.false_alarms);
    Ok(Holding { slip, warning })
}

fn one(finger: &Finger, learned: &Bench, seed: u64) -> anyhow::Result<[Card; 2]> {
    let scene = minute(finger, seed, true)?;
    let world = World::seeded(&scene, Seeds { making: finger.making, noise: seed });
    let trial = learned.clone().run(world, Judge::Touch);
    let held = Stretch { from_s: FROM_S, to_s: scene.duration_s(), doing: Doing::Hold };
    let card = |word| Card::of(&fate::spans(&trial.truth), &trial.verdicts(word), &[held]);
    Ok([Word::Slip, Word::Warning].map(card))
}

/// A minute by chance; without disturbances nothing happens in it. Fails if the scene cannot be made.
pub fn minute(finger: &Finger, seed: u64, disturbed: bool) -> anyhow::Result<SceneFile> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut between = |low: f64, high: f64| rng.random_range(low..high);
    // One after the other, so that no two are on top of each other.
    let count = KNOCKS + SWINGS + RUNS;
    let mut places: Vec<u32> = (0..count).collect();
    for n in (1..places.len()).rev() {
        places.swap(n, (between(0.0, 1.0) * (n + 1) as f64) as usize);
    }
    let slot_s = (59.0 - FROM_S - 1.0) / f64::from(count);
    let at_s = |n: u32, within: f64| FROM_S + 1.0 + slot_s * (f64::from(places[n as usize]) + within);
    let mut knocks = Vec::new();
    for n in 0..KNOCKS {
        knocks.push(entry(&[
            ("at_s", at_s(n, between(0.0, 0.5))),
            ("peak_mv", 2.0 * (between(0.0, 40.0_f64.ln())).exp()),
            // Frames and tools ring from 50 Hz to 2 kHz for 1 to 30 ms; where it comes from decides which films hear it.
            ("ring_hz", between(50.0_f64.ln(), 2_000.0_f64.ln()).exp()),
            ("decay_ms", between(0.0, 30.0_f64.ln()).exp()),
            ("uneven", between(0.0, 1.0)),
        ]));
    }
    let mut swings = Vec::new();
    for n in KNOCKS..KNOCKS + SWINGS {
        let mut swing = entry(&[
            ("at_s", at_s(n, 0.0)),
            ("rate_hz", between(0.8, 1.5)),
            ("peak_m_s2", between(1.0, 3.0)),
        ]);
        swing.insert("cycles".to_owned(), (between(1.0, 4.0) as i64).into());
        swings.push(swing);
    }
    let mut runs = Vec::new();
    for n in KNOCKS + SWINGS..count {
        let mut run = entry(&[("at_s", at_s(n, between(0.0, 0.5))), ("for_s", between(0.02, 0.1))]);
        run.insert("kind".to_owned(), "close".into());
        run.insert("duty_permille".to_owned(), (between(100.0, 300.0) as i64).into());
        runs.push(run);
    }
    finger.scene(SCENE, seed, &[("command.grip.for_s", (2.0 + 16.7 * finger.force()) / 24.0)], |scene| {
        for (kind, mut entries) in [("knock", knocks), ("swing", swings)] {
            entries.retain(|_| disturbed);
            scene.insert(
                kind.to_owned(),
                entries.into_iter().map(toml::Value::from).collect::<Vec<_>>().into(),
            );
        }
        let commands = scene.get_mut("command").and_then(toml::Value::as_array_mut);
        if let Some(commands) = commands {
            commands.truncate(2);
            commands.extend(runs.into_iter().filter(|_| disturbed).map(Into::into));
        }
    })
}
