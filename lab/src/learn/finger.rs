//! Whose finger learns, and on what: one that is as the scene file says, or one made by chance.

use anyhow::Context;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_scene::{SceneFile, builtin};

const GRAVITY_M_S2: f64 = 9.80665;
/// Force at which the block of the scene file stops sliding, N: `m g / (2 mu_d)`.
const NEEDED_N: f64 = 0.2 * GRAVITY_M_S2 / (2.0 * 0.46);

/// Friction of the plain finger: sliding keeps 0.65 of it, and a patch of it holds 0.69 of its load, both as the recorded finger
/// does (`scenes/rig.toml`).
const PLAIN_MU_S: f64 = 0.90;
const PLAIN_MU_D: f64 = 0.65 * PLAIN_MU_S;
/// Its block: as heavy as needs the force of the scene file's.
const PLAIN_KG: f64 = NEEDED_N * 2.0 * PLAIN_MU_D / GRAVITY_M_S2;

/// Deviation of the mains' frequency, Hz: EN 50160's limit for 99.5 % of the year.
const OFF_HZ: f64 = 0.5;

/// A change of a number of a scene file: where (`contact.mu_s`, `move.0.at_s`), and to what.
pub type Change = (&'static str, f64);

/// A fingertip and the object that it practises on.
#[derive(Clone, Debug)]
pub struct Finger {
    /// Seed of its making: where films and gauges lie, their gains, signs, offsets.
    pub making: u64,
    mu_s: f64,
    mu_d: f64,
    mass_kg: f64,
    /// Force that its object needs, times that of the scene file's block.
    force: f64,
    changes: Vec<Change>,
}

impl Finger {
    /// The scene files' own, but for its friction.
    pub const fn plain(making: u64) -> Self {
        Self {
            making,
            mu_s: PLAIN_MU_S,
            mu_d: PLAIN_MU_D,
            mass_kg: PLAIN_KG,
            force: 1.0,
            changes: Vec::new(),
        }
    }

    /// Its skin, contact, films, gauges and object are drawn over about a decade each where nobody has measured them; friction has the
    /// ends of `dataset::material`, and sliding keeps 0.6 to 0.95 of it.
    pub fn random(seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut between = |low: f64, high: f64| rng.random_range(low..high);
        let ratio = between(0.6, 0.95);
        let mut decade = |low: f64, high: f64| between(low.ln(), high.ln()).exp();
        let mu_s = decade(0.25, 1.2);
        let mu_d = mu_s * ratio;
        let force = decade(0.8, 1.5);
        let (films, gauges) = (decade(0.6, 1.25), decade(0.6, 1.4));
        Self {
            making: seed,
            mu_s,
            mu_d,
            mass_kg: force * NEEDED_N * 2.0 * mu_d / GRAVITY_M_S2,
            force,
            changes: vec![
                ("contact.pitch_mm", decade(0.3, 3.0)),
                ("contact.patch_radius_mm", decade(4.0, 6.0)),
                ("contact.skin_n_per_mm", decade(1.5, 10.0)),
                ("contact.skin_ms", decade(1.0, 5.0)),
                ("pvdf.gain", 20.0 * films),
                ("pvdf.spread", decade(0.06, 0.6)),
                ("pvdf.film_decades", 1.0),
                // The recorded onset gives 37 to 61 mV for a shear that nobody measured: 0.1 to 1 N.
                ("pvdf.release_mv_per_n", decade(60.0, 600.0)),
                ("pvdf.mains_mv", decade(0.1, 1.0)),
                ("pvdf.noise_mv", decade(0.1, 1.0)),
                ("strain.normal_mv_per_n", 60.0 * gauges),
                ("strain.shear_mv_per_n", 120.0 * gauges),
                ("strain.spread", decade(0.06, 0.6)),
                ("pvdf.mains_hz", 50.0 + OFF_HZ * (2.0 * rng.random_range(0.0..1.0) - 1.0)),
            ],
        }
    }

    /// The scene of this name with this finger and its object, edited. Friction and mass differ by up to 3 %, the first grip by 5 %, from
    /// one seed to the next. Fails if the scene does not become one with these numbers.
    pub fn scene(
        &self,
        name: &str,
        seed: u64,
        more: &[Change],
        edit: impl FnOnce(&mut toml::Table),
    ) -> anyhow::Result<SceneFile> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut about = |value: f64, part: f64| value * rng.random_range(1.0 - part..1.0 + part);
        let rub = about(1.0, 0.03);
        let mut changes = self.changes.clone();
        changes.extend([
            ("contact.mu_s", self.mu_s * rub),
            ("contact.mu_d", self.mu_d * rub),
            ("object.mass_kg", about(self.mass_kg, 0.03)),
            // The fingers have 1 mm each to go, and press 0.3 N for each mm after that.
            ("command.grip.for_s", (2.0 + 3.2 * self.force * about(1.0, 0.05)) / 12.0),
            ("command.more.duty_permille", (24.0 * self.force).round()),
        ]);
        changes.extend_from_slice(more);
        let (file, text) = builtin::find(name).with_context(|| format!("no scene is called {name}"))?;
        let mut scene = SceneFile::table(&text, &file)?;
        for (place, value) in &changes {
            set(&mut scene, place, *value).with_context(|| format!("scene {name} has no {place}"))?;
        }
        edit(&mut scene);
        Ok(SceneFile::parse(&toml::to_string(&scene)?, name)?)
    }

    pub const fn friction(&self) -> [f64; 2] {
        [self.mu_s, self.mu_d]
    }

    /// Puts its films, gauges, skin and friction in the place of a scene's.
    pub fn put_on(&self, scene: &mut toml::Table) {
        let friction = [("contact.mu_s", self.mu_s), ("contact.mu_d", self.mu_d)];
        for (place, value) in self.changes.iter().chain(&friction) {
            // Of two parts, so there is nothing that could be missing.
            let _is_there = set(scene, place, *value);
        }
    }

    pub fn with(mut self, change: Change) -> Self {
        self.changes.retain(|(place, _)| *place != change.0);
        self.changes.push(change);
        self
    }

    pub const fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    pub const fn force(&self) -> f64 {
        self.force
    }
}

/// Sets a number: of a table (`contact.mu_s`), of an entry of a list (`move.0.at_s`), or of the first or second command
/// that closes the fingers (`command.grip.for_s`, `command.more.for_s`), if there is one.
fn set(scene: &mut toml::Table, place: &str, value: f64) -> Option<()> {
    let mut parts = place.split('.');
    let (section, second) = (parts.next()?, parts.next()?);
    let Some(key) = parts.next() else {
        let table = scene.entry(section).or_insert_with(|| toml::Table::new().into()).as_table_mut()?;
        table.insert(second.to_owned(), value.into());
        return Some(());
    };
    let entries = scene.get_mut(section)?.as_array_mut()?;
    let entry = match second {
        "grip" => closing(entries, 0),
        "more" => closing(entries, 1),
        n => entries.get_mut(n.parse::<usize>().ok()?),
    };
    // A scene whose fingers close once has nothing more to change.
    if let Some(table) = entry.and_then(toml::Value::as_table_mut) {
        let whole = table.get(key).is_some_and(toml::Value::is_integer);
        table.insert(key.to_owned(), if whole { (value as i64).into() } else { value.into() });
    }
    Some(())
}

/// The nth command that closes the fingers; one with a duty of 0 only holds them.
fn closing(entries: &mut [toml::Value], n: usize) -> Option<&mut toml::Value> {
    let closes = |entry: &toml::Value| {
        entry.get("kind").and_then(toml::Value::as_str) == Some("close")
            && entry.get("duty_permille").and_then(toml::Value::as_integer) != Some(0)
    };
    entries.iter_mut().filter(|entry| closes(entry)).nth(n)
}
