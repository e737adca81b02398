//! The stories of a session: three scenes of the repository, with the session's numbers in place of theirs.

use anyhow::Context;
use rand::{RngExt, rngs::ChaCha8Rng};
use tenax_scene::physics::GRAVITY_M_S2;
use tenax_scene::{SceneFile, builtin};
use toml::{Table, Value};

use super::session::Session;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Story {
    /// Bamshad 2023, section 3.2: balls are poured in until it slips, again and again.
    Pour,
    /// The first task of section 6: picked up, and placed back.
    Pick,
    /// Knocks, arm swing, tremor, the motor, a bad supply: nothing slips.
    Disturb,
}

impl Story {
    pub const ALL: [Self; 3] = [Self::Pour, Self::Pick, Self::Disturb];

    pub const fn name(self) -> &'static str {
        match self {
            Self::Pour => "pour",
            Self::Pick => "pick",
            Self::Disturb => "disturb",
        }
    }

    const fn scene(self) -> &'static str {
        match self {
            Self::Pour => "array-pour",
            Self::Pick => "array-pick",
            Self::Disturb => "array-disturb",
        }
    }

    /// The scene of this story in this session, edited. Fails if a number is none that a scene may have.
    pub fn scene_in(
        self,
        session: &Session,
        rng: &mut ChaCha8Rng,
        edit: impl FnOnce(&mut Table),
    ) -> anyhow::Result<SceneFile> {
        let (mut scene, duration_s) = self.told(session, rng)?;
        edit(&mut scene);
        finish(scene, duration_s, &format!("{} in {}", self.scene(), session.name))
    }

    /// The repository's scene with the session's numbers, and how long it lasts, s.
    fn told(self, session: &Session, rng: &mut ChaCha8Rng) -> anyhow::Result<(Table, f64)> {
        let name = self.scene();
        let (file, text) = builtin::find(name).with_context(|| format!("the scene {name} is not there"))?;
        let mut scene = SceneFile::table(&text, &file)?;
        let duration_s = self.retell(&mut scene, rng);
        // A bad supply or a motor's cable is one more disturbance, and no slip.
        let noisier = if self == Self::Disturb { rng.random_range(NOISIER) } else { 1.0 };
        let numbers = [
            ("contact", "mu_s", session.mu_s),
            ("contact", "mu_d", session.mu_d),
            ("contact", "mu_per_decade", session.mu_per_decade),
            ("contact", "pitch_mm", session.pitch_mm),
            ("object", "stiffness_n_per_mm", session.stiffness_n_per_mm),
            ("pitch", "offset_mm", session.offset_mm),
            ("pitch", "hang_mm", session.hang_mm),
            ("array", "uneven", session.uneven),
            ("array", "renews_um", session.renews_um),
            ("array", "slip_part", session.slip_part),
            ("array", "rim_part", session.rim_part),
            ("array", "knock_mn_per_mv", session.knock_mn_per_mv),
            ("array", "motor_part", session.motor_part),
            ("array", "tilt", session.tilt),
            ("array", "place_mm", session.place_mm),
            ("array", "mv_per_n", session.mv_per_n),
            ("array", "spread", session.spread),
            ("array", "noise_mv", session.noise_mv * noisier),
        ];
        for (section, key, value) in numbers {
            put(&mut scene, section, key, Value::from(value));
        }
        put(&mut scene, "array", "specimen", Value::from(session.specimen));
        Ok((scene, duration_s))
    }

    /// The story for a fingertip that has to hold the box itself, once somebody has closed the hand on it with about
    /// what holds it: nobody tightens the grip but the fingertip. Fails if a drawn number is none that a scene may have.
    pub fn task_in(self, session: &Session, rng: &mut ChaCha8Rng) -> anyhow::Result<SceneFile> {
        let (mut scene, duration_s) = self.told(session, rng)?;
        let mass_kg = number(&scene, "object", "mass_kg");
        let part = rng.random_range(1.05..1.4);
        let grip_n = part * mass_kg * GRAVITY_M_S2 / 2.0 / session.mu_d;
        let mut commands = vec![drive("close", 0.4, closing_s(&scene, grip_n, session))];
        if self == Self::Pick {
            commands.push(drive("open", 7.5, 1.0));
        }
        scene.insert("command".to_owned(), Value::Array(commands));
        finish(scene, duration_s, &format!("{} in {}", self.scene(), session.name))
    }

    /// Draws when and how much; gives how long it lasts, s.
    fn retell(self, scene: &mut Table, rng: &mut ChaCha8Rng) -> f64 {
        // Somebody else grips (`super::operator`), or `task_in` says how.
        scene.remove("command");
        match self {
            Self::Pour => {
                put(scene, "object", "mass_kg", Value::from(rng.random_range(0.06..0.12)));
                let (mut fills, mut at_s) = (Vec::new(), 4.0);
                while at_s < POUR_S - 3.0 {
                    let for_s = rng.random_range(1.0..3.0);
                    fills.push(Value::Table(entry(&[
                        ("at_s", at_s),
                        ("for_s", for_s),
                        ("add_kg", rng.random_range(0.05..0.13)),
                    ])));
                    at_s += for_s + rng.random_range(0.3..1.5);
                }
                scene.insert("fill".to_owned(), Value::Array(fills));
                POUR_S
            }
            Self::Pick => {
                put(scene, "object", "mass_kg", Value::from(rng.random_range(0.10..0.45)));
                PICK_S
            }
            Self::Disturb => {
                put(scene, "object", "mass_kg", Value::from(rng.random_range(0.10..0.30)));
                let knock = |rng: &mut ChaCha8Rng, at_s: f64| {
                    Value::Table(entry(&[
                        ("at_s", at_s + rng.random_range(0.0..0.5)),
                        ("peak_mv", over_decades(rng, 30.0..300.0)),
                        // Frames and tools ring from 50 Hz to 2 kHz, for 1 to 30 ms.
                        ("ring_hz", over_decades(rng, 50.0..2_000.0)),
                        ("decay_ms", over_decades(rng, 1.0..30.0)),
                        ("uneven", rng.random_range(0.0..1.0)),
                    ]))
                };
                let knocks = (0..5).map(|n| knock(rng, 3.3 + 0.6 * f64::from(n))).collect();
                let mut swing = |at_s: f64, cycles: i64, rate_hz: f64, peak: std::ops::Range<f64>| {
                    let mut swing =
                        entry(&[("at_s", at_s), ("rate_hz", rate_hz), ("peak_m_s2", rng.random_range(peak))]);
                    swing.insert("cycles".to_owned(), Value::from(cycles));
                    Value::Table(swing)
                };
                let swings = vec![swing(6.4, 3, 1.5, 1.0..6.0), swing(8.6, 12, 9.0, 0.3..1.5)];
                scene.insert("knock".to_owned(), Value::Array(knocks));
                scene.insert("swing".to_owned(), Value::Array(swings));
                DISTURB_S
            }
        }
    }
}

fn over_decades(rng: &mut ChaCha8Rng, ends: std::ops::Range<f64>) -> f64 {
    rng.random_range(ends.start.ln()..ends.end.ln()).exp()
}

/// Duration of a pour, s.
const POUR_S: f64 = 26.0;
/// Duration of a pick and place, s.
const PICK_S: f64 = 9.0;
/// Duration of the disturbances, s; in the last 3 s the grip changes.
const DISTURB_S: f64 = 13.0;

const NOISIER: std::ops::Range<f64> = 1.0..5.0;

/// Duty of closing on the box and of opening, per mille.
const DUTY: i64 = 300;

fn finish(mut scene: Table, duration_s: f64, called: &str) -> anyhow::Result<SceneFile> {
    scene.insert("duration_s".to_owned(), Value::from(duration_s));
    Ok(SceneFile::parse(&scene.to_string(), called)?)
}

fn drive(kind: &str, at_s: f64, for_s: f64) -> Value {
    let mut drive = entry(&[("at_s", at_s), ("for_s", for_s)]);
    drive.insert("kind".to_owned(), Value::from(kind));
    drive.insert("duty_permille".to_owned(), Value::from(DUTY));
    Value::Table(drive)
}

/// Time of closing until each finger presses with `grip_n`, s: over the gap, and then against a spring
/// that slows it.
fn closing_s(scene: &Table, grip_n: f64, session: &Session) -> f64 {
    let of = |section: &str, key: &str| number(scene, section, key);
    let duty = DUTY as f64 / 1e3;
    let speed_mm_s = of("gripper", "speed_mm_s");
    let gap_s = (of("gripper", "opening_mm") - of("object", "width_mm")) / (duty * speed_mm_s);
    let stall_n = duty * of("gripper", "force_n");
    let spring_s = 2.0 * of("gripper", "force_n") / (speed_mm_s * session.stiffness_n_per_mm);
    let closing_s = gap_s - spring_s * (1.0 - (grip_n / stall_n).min(0.95)).ln();
    // The logarithm may differ in its last bits from one platform to the next.
    (closing_s * 1e3).round() / 1e3
}

/// A number of a scene; 0 if it does not say.
fn number(scene: &Table, section: &str, key: &str) -> f64 {
    let value = scene.get(section).and_then(|section| section.get(key));
    value.map_or(0.0, |value| value.as_float().or(value.as_integer().map(|n| n as f64)).unwrap_or(0.0))
}

/// An entry of a scene's list.
pub fn entry(keys: &[(&str, f64)]) -> Table {
    keys.iter().map(|&(key, value)| (key.to_owned(), Value::from(value))).collect()
}

fn put(scene: &mut Table, section: &str, key: &str, value: Value) {
    let section = scene.entry(section).or_insert_with(|| Value::Table(Table::new()));
    if let Value::Table(section) = section {
        section.insert(key.to_owned(), value);
    }
}
