//! A recipe: the analogue front end between a recording's columns and this board's pins (`docs/recipes.md`).

use std::fmt::Display;
use std::ops::Range;

use serde::Deserialize;
use tenax_hal_shim::channel;
use toml::Spanned;

use super::meaning::Meaning;
use crate::input::Table;

/// Where in the file it is wrong, and how.
pub(super) type Checked = Result<(), (Range<usize>, String)>;

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    pub title: String,
    pub description: String,
    /// Names of the recordings that it is taken for when no recipe is given; `*` and `?` match as in a shell.
    #[serde(default)]
    pub applies_to: Vec<Spanned<String>>,
    pub table: Option<Spanned<Table>>,
    #[serde(default)]
    pub time: Time,
    /// How long the first row is held before the recording begins, s: the fingertip's filters and baselines settle in it.
    #[serde(default = "one")]
    pub lead_in_s: Spanned<f64>,
    /// How long the last row is held after the recording ends, s.
    #[serde(default = "default_lead_out_s")]
    pub lead_out_s: Spanned<f64>,
    #[serde(default)]
    pub map: Vec<Map>,
    /// Columns in newtons that press the force sensor.
    pub force: Option<ForceMap>,
    #[serde(default)]
    pub hold: Hold,
    #[serde(default)]
    pub meaning: Vec<Meaning>,
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Time {
    pub column: Option<String>,
    #[serde(default)]
    pub unit: TimeUnit,
    /// Rows a second, of a table without a time column.
    pub rate_hz: Option<Spanned<f64>>,
}

impl Time {
    pub fn of_rate(hz: f64) -> Self {
        Self { rate_hz: Some(Spanned::new(0..0, hz)), ..Self::default() }
    }
}

#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub enum TimeUnit {
    #[default]
    #[serde(rename = "s")]
    Seconds,
    #[serde(rename = "ms")]
    Milliseconds,
    #[serde(rename = "us")]
    Microseconds,
    #[serde(rename = "ns")]
    Nanoseconds,
}

impl TimeUnit {
    pub const fn in_a_second(self) -> f64 {
        match self {
            Self::Seconds => 1.0,
            Self::Milliseconds => 1e3,
            Self::Microseconds => 1e6,
            Self::Nanoseconds => 1e9,
        }
    }
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Map {
    pub column: String,
    pub channels: Vec<Spanned<String>>,
    pub remove_offset: Option<RemoveOffset>,
    /// Corners of second-order Butterworth filters, Hz; the envelope's low-pass stands behind the rectifier.
    pub high_pass_hz: Option<Spanned<f64>>,
    pub low_pass_hz: Option<Spanned<f64>>,
    #[serde(default)]
    pub rectify: bool,
    pub envelope_hz: Option<Spanned<f64>>,
    pub gain: Spanned<f64>,
    pub offset_v: Option<Spanned<f64>>,
    #[serde(default = "default_clip_v")]
    pub clip_v: Spanned<[f64; 2]>,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum RemoveOffset {
    Mean,
    MeanOfFirstS(f64),
    Value(f64),
}

/// Columns in newtons that press the four quadrants ([`front_end`](tenax_hal_shim::front_end)).
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForceMap {
    pub normal: String,
    pub shear_x: String,
    pub shear_y: Option<String>,
    #[serde(default = "one")]
    pub scale: Spanned<f64>,
    /// Corner of a second-order Butterworth low-pass, Hz: the rubber of the tilting element.
    pub low_pass_hz: Option<Spanned<f64>>,
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hold {
    pub force: Option<Spanned<HoldForce>>,
    #[serde(default)]
    pub pins: Vec<HoldPins>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HoldForce {
    pub normal_n: f64,
    /// Shear along x, N.
    #[serde(default)]
    pub shear_n: f64,
    /// The finger is unloaded for so long after the board was switched on, s: its zero is taken then.
    #[serde(default)]
    pub after_s: f64,
    /// How long the load then takes to come on, s.
    #[serde(default)]
    pub ramp_s: f64,
    pub why: String,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HoldPins {
    pub channels: Vec<Spanned<String>>,
    pub volts: Spanned<f64>,
    pub why: String,
}

/// A factor of 1, for a value that is not given: it has no place in the file, and is never wrong.
fn one() -> Spanned<f64> {
    Spanned::new(0..0, 1.0)
}

fn default_lead_out_s() -> Spanned<f64> {
    Spanned::new(0..0, 0.2)
}

fn default_clip_v() -> Spanned<[f64; 2]> {
    Spanned::new(0..0, [0.05, 3.2])
}

impl Recipe {
    pub fn meaning_of(&self, file_name: &str) -> Option<&Meaning> {
        self.meaning.iter().find(|meaning| meaning.is_for(file_name))
    }

    /// Channels that a column reaches. Empty where it reaches none.
    pub fn goes_to(&self, column: &str) -> String {
        let mapped = self.map.iter().filter(|map| map.column == column).flat_map(|map| &map.channels);
        let pressed = self.force.iter().flat_map(|force| {
            [
                ("normal force", Some(&force.normal)),
                ("shear x", Some(&force.shear_x)),
                ("shear y", force.shear_y.as_ref()),
            ]
        });
        let pressed = pressed.filter(|(_, own)| own.is_some_and(|own| own == column)).map(|(name, _)| name);
        mapped.map(|name| name.get_ref().as_str()).chain(pressed).collect::<Vec<_>>().join(", ")
    }

    pub fn table(&self) -> Table {
        self.table.as_ref().map_or_else(Table::default, |table| *table.get_ref())
    }

    pub fn maps_a_muscle(&self) -> bool {
        self.map.iter().any(Map::is_muscle)
    }

    pub(super) fn check(&self) -> Checked {
        let named = self.meaning.iter().map(|meaning| &meaning.named);
        for pattern in self.applies_to.iter().chain(named) {
            glob::Pattern::new(pattern.get_ref()).map_err(|error| {
                (pattern.span(), format!("`{}` is no pattern: {error}", pattern.get_ref()))
            })?;
        }
        if let Some(table) = &self.table {
            table.get_ref().check().map_err(|what| (table.span(), what))?;
        }
        if_within(&self.time.rate_hz, "rate_hz", 1.0, 100_000.0)?;
        if let (Some(rate), Some(_)) = (&self.time.rate_hz, &self.time.column) {
            return Err((rate.span(), "give either rate_hz or column, not both".into()));
        }
        within(&self.lead_in_s, "lead_in_s", 0.0, 60.0)?;
        within(&self.lead_out_s, "lead_out_s", 0.0, 60.0)?;
        if self.map.is_empty() && self.force.is_none() {
            return Err((0..0, "nothing is mapped: at least one [[map]] or a [force] is needed".into()));
        }
        let mut taken: Vec<&str> = Vec::new();
        for map in &self.map {
            map.check()?;
            claim(&mut taken, &map.channels)?;
        }
        for pins in &self.hold.pins {
            within(&pins.volts, "volts", 0.0, 3.3)?;
            claim(&mut taken, &pins.channels)?;
        }
        if let Some(force) = &self.force {
            if !force.scale.get_ref().is_finite() || *force.scale.get_ref() == 0.0 {
                return Err((force.scale.span(), "scale must be a number other than 0".into()));
            }
            corner(&force.low_pass_hz, "low_pass_hz")?;
        }
        match (&self.force, &self.hold.force) {
            (Some(_), Some(hold)) => {
                Err((hold.span(), "[force] and [hold.force] both press the force sensor; keep one".into()))
            }
            (None, Some(hold)) => hold.get_ref().check().map_err(|what| (hold.span(), what)),
            _ => Ok(()),
        }
    }
}

impl Map {
    pub fn is_muscle(&self) -> bool {
        let muscles = [channel::MYO_FLEXOR, channel::MYO_EXTENSOR];
        let indices = self.channels.iter().filter_map(|name| channel::by_name(name.get_ref()));
        indices.into_iter().any(|index| muscles.contains(&index))
    }

    fn check(&self) -> Checked {
        corner(&self.high_pass_hz, "high_pass_hz")?;
        corner(&self.low_pass_hz, "low_pass_hz")?;
        corner(&self.envelope_hz, "envelope_hz")?;
        if !self.gain.get_ref().is_finite() {
            let what = "gain must be a finite number, in volts per unit of the column";
            return Err((self.gain.span(), what.into()));
        }
        if_within(&self.offset_v, "offset_v", 0.0, 3.3)?;
        let [low, high] = *self.clip_v.get_ref();
        if !(0.0..=3.3).contains(&low) || !(0.0..=3.3).contains(&high) || low >= high {
            let what = "clip_v is [lowest, highest] voltage at the pin, between 0 and 3.3";
            return Err((self.clip_v.span(), what.into()));
        }
        Ok(())
    }
}

impl HoldForce {
    fn check(&self) -> Result<(), String> {
        let allowed = 0.0..=140.0;
        if !allowed.contains(&self.normal_n) || !allowed.contains(&self.shear_n.abs()) {
            return Err("normal_n and shear_n are newtons, at most 140".into());
        }
        if !(0.0..=60.0).contains(&self.after_s) || !(0.0..=60.0).contains(&self.ramp_s) {
            return Err("after_s and ramp_s are seconds, 0 to 60".into());
        }
        Ok(())
    }
}

pub(super) fn matches<'p>(patterns: impl IntoIterator<Item = &'p Spanned<String>>, file_name: &str) -> bool {
    let matches = |pattern: &Spanned<String>| {
        glob::Pattern::new(pattern.get_ref()).is_ok_and(|pattern| pattern.matches(file_name))
    };
    patterns.into_iter().any(matches)
}

fn within<T: PartialOrd + Display>(value: &Spanned<T>, name: &str, low: T, high: T) -> Checked {
    let own = value.get_ref();
    if *own >= low && *own <= high {
        return Ok(());
    }
    Err((value.span(), format!("{name} is {own}; {low} to {high} is allowed")))
}

fn if_within<T: PartialOrd + Display>(value: &Option<Spanned<T>>, name: &str, low: T, high: T) -> Checked {
    value.as_ref().map_or(Ok(()), |value| within(value, name, low, high))
}

fn corner(value: &Option<Spanned<f64>>, name: &str) -> Checked {
    if_within(value, name, 0.01, 3_000.0)
}

fn claim<'a>(taken: &mut Vec<&'a str>, channels: &'a [Spanned<String>]) -> Checked {
    for name in channels {
        if channel::by_name(name.get_ref()).is_none() {
            let names: Vec<&str> = channel::CHANNELS.iter().map(|channel| channel.name).collect();
            let what =
                format!("no channel is called `{}`; the channels are {}", name.get_ref(), names.join(", "));
            return Err((name.span(), what));
        }
        if taken.contains(&name.get_ref().as_str()) {
            return Err((name.span(), format!("channel `{}` is given twice", name.get_ref())));
        }
        taken.push(name.get_ref());
    }
    Ok(())
}
