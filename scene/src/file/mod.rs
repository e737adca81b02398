//! Scene files: TOML in, a checked [`SceneFile`] out, or one message that says where and what is allowed.

mod base;
mod channel;
mod check;
mod defaults;
mod error;
mod happening;
pub(crate) mod quantity;
pub(crate) mod sections;
mod step;

pub use base::Find;
use base::Sources;
use serde::Deserialize;
use std::ops::Range;
use tenax_hal_shim::channel::MYO_FLEXOR;
use tenax_logic::setting::SettingId;
use toml::Spanned;

use crate::builtin::find;

pub use error::SceneError;
pub use happening::Happening;
use quantity::{Duration, Speed};
use sections::{
    Arm, Array, Camera, Command, CommandKind, Contact, ElectrodeLift, Fill, Fsr, Gripper, Hum, Jam, Knock,
    Move, Muscle, Myo, Object, Photoelastic, Pitch, Press, Pull, Pvdf, Robot, SensorFault, Skin, Strain,
    Sweep, Swing, Table, Vibrator, Wet,
};

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    pub name: String,
    pub title: String,
    /// The paper and section that it is made after.
    pub from: String,
    duration_s: Duration,
    slip_floor_mm_s: Speed,
    #[serde(default)]
    pub(crate) arm: Arm,
    pub(crate) contact: Contact,
    pub(crate) object: Option<Spanned<Object>>,
    pub(crate) pitch: Option<Spanned<Pitch>>,
    #[serde(default)]
    pub(crate) table: Table,
    pub(crate) robot: Option<Spanned<Robot>>,
    #[serde(default)]
    pub(crate) gripper: Gripper,
    #[serde(default)]
    pub(crate) pvdf: Pvdf,
    #[serde(default)]
    pub(crate) fsr: Fsr,
    #[serde(default)]
    pub(crate) myo: Myo,
    #[serde(default)]
    pub(crate) strain: Strain,
    #[serde(default)]
    pub(crate) array: Array,
    #[serde(default)]
    pub(crate) camera: Camera,
    pub(crate) photoelastic: Option<Photoelastic>,
    pub(crate) skin: Option<Skin>,
    pub(crate) vibrator: Option<Vibrator>,
    #[serde(default)]
    pub(crate) wet: Vec<Wet>,
    #[serde(default)]
    pub(crate) fill: Vec<Fill>,
    #[serde(default, rename = "move")]
    pub(crate) moves: Vec<Move>,
    #[serde(default)]
    pub(crate) swing: Vec<Swing>,
    #[serde(default)]
    pub(crate) pull: Vec<Pull>,
    #[serde(default)]
    pub(crate) press: Vec<Press>,
    #[serde(default)]
    pub(crate) sweep: Vec<Sweep>,
    #[serde(default)]
    pub(crate) knock: Vec<Knock>,
    #[serde(default)]
    pub(crate) hum: Vec<Hum>,
    #[serde(default)]
    pub(crate) muscle: Vec<Muscle>,
    #[serde(default)]
    pub(crate) electrode_lift: Vec<ElectrodeLift>,
    #[serde(default)]
    pub(crate) jam: Vec<Jam>,
    #[serde(default)]
    pub(crate) fault: Vec<SensorFault>,
    #[serde(default)]
    pub(crate) command: Vec<Command>,
    pub(crate) line_trusted: Option<bool>,
}

impl SceneFile {
    /// Reads a scene, whose base is one of the program's. `file_name` is what errors call it.
    /// An error says the file, the line, the key, and what is allowed there.
    pub fn parse(text: &str, file_name: &str) -> Result<Self, SceneError> {
        Self::parse_upon(text, file_name, &find)
    }

    /// Reads a scene whose base is what `find` gives for its name.
    /// An error says the file, the line, the key, and what is allowed there; the file may be the base.
    pub fn parse_upon(text: &str, file_name: &str, find: Find<'_>) -> Result<Self, SceneError> {
        let sources = Sources::read(text, file_name, find)?;
        let scene = Self::deserialize(toml::Deserializer::from(sources.merged()?))
            .map_err(|error| sources.of_toml(error.span().unwrap_or(0..0), error.message()))?;
        check::check(&scene).map_err(|wrong| sources.wrong(wrong.span, wrong.what))?;
        Ok(scene)
    }

    /// A scene and what it stands on as one table, unchecked: for whoever draws its numbers anew.
    /// Fails if it is no TOML, or its base is not there.
    pub fn table(text: &str, file_name: &str) -> Result<toml::Table, SceneError> {
        let sources = Sources::read(text, file_name, &find)?;
        toml::Table::deserialize(toml::Deserializer::from(sources.merged()?))
            .map_err(|error| sources.of_toml(error.span().unwrap_or(0..0), error.message()))
    }

    pub fn trusts_line(&self) -> bool {
        self.line_trusted.unwrap_or(!self.command.is_empty() || self.camera.teaches || self.skin.is_some())
    }

    pub fn fits_head(&self) -> bool {
        let fits = |command: &Command| {
            *command.kind.get_ref() == CommandKind::Set(SettingId::Head)
                && command.value.as_ref().is_some_and(|value| *value.get_ref() > 0)
        };
        self.command.iter().any(fits)
    }

    pub fn lifts(&self) -> impl Iterator<Item = (usize, Range<f64>)> + '_ {
        self.electrode_lift.iter().map(|lift| {
            let at_s = lift.at_s.get_ref().get();
            // What it heard is smoothed: it falls for as long as an envelope rises, from 3 V in 0.1 s.
            let settles_s = 1.7 * self.myo.rise_ms.get() / 1e3;
            (lift.channel.get_ref().index() - MYO_FLEXOR, at_s..at_s + lift.for_s.get() + settles_s)
        })
    }

    pub const fn duration_s(&self) -> f64 {
        self.duration_s.get()
    }

    pub const fn slip_floor_mm_s(&self) -> f64 {
        self.slip_floor_mm_s.get()
    }
}
