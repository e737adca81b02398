//! Scene files: TOML in, a checked [`SceneFile`] out, or one message that says where and what is allowed.

mod base;
mod check;
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

pub use happening::Happening;
use quantity::{Duration, Speed};
use sections::{
    Arm, Array, Camera, Command, CommandKind, Contact, ElectrodeLift, Fill, Fsr, Gripper, Hum, Jam, Knock,
    Move, Muscle, Myo, Object, Photoelastic, Pitch, Press, Pull, Pvdf, Robot, SensorFault, Skin, Strain,
    Sweep, Swing, Table, Vibrator, Wet,
};

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: {what}")]
pub struct SceneError {
    file: String,
    line: usize,
    what: String,
}

/// The four names that are nearest to `name`, in one line.
fn near<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let mut known: Vec<&str> = known.collect();
    known.sort_by(|a, b| strsim::jaro_winkler(b, name).total_cmp(&strsim::jaro_winkler(a, name)));
    known.truncate(4);
    known.join(", ")
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    pub name: String,
    pub title: String,
    /// The paper and section that it is made after.
    pub from: String,
    duration_s: Duration,
    slip_floor_mm_s: Speed,
    pub(crate) arm: Arm,
    pub(crate) contact: Contact,
    pub(crate) object: Option<Spanned<Object>>,
    pub(crate) pitch: Option<Spanned<Pitch>>,
    pub(crate) table: Table,
    pub(crate) robot: Option<Spanned<Robot>>,
    pub(crate) gripper: Gripper,
    pub(crate) pvdf: Pvdf,
    pub(crate) fsr: Fsr,
    pub(crate) myo: Myo,
    pub(crate) strain: Strain,
    pub(crate) array: Array,
    pub(crate) camera: Camera,
    pub(crate) photoelastic: Option<Photoelastic>,
    pub(crate) skin: Option<Skin>,
    pub(crate) vibrator: Option<Vibrator>,
    pub(crate) wet: Vec<Wet>,
    pub(crate) fill: Vec<Fill>,
    #[serde(rename = "move")]
    pub(crate) moves: Vec<Move>,
    pub(crate) swing: Vec<Swing>,
    pub(crate) pull: Vec<Pull>,
    pub(crate) press: Vec<Press>,
    pub(crate) sweep: Vec<Sweep>,
    pub(crate) knock: Vec<Knock>,
    pub(crate) hum: Vec<Hum>,
    pub(crate) muscle: Vec<Muscle>,
    pub(crate) electrode_lift: Vec<ElectrodeLift>,
    pub(crate) jam: Vec<Jam>,
    pub(crate) fault: Vec<SensorFault>,
    pub(crate) command: Vec<Command>,
    pub(crate) line_trusted: Option<bool>,
}

impl SceneFile {
    /// Reads a scene, whose base is one of the program's. `file_name` is what errors call it.
    pub fn parse(text: &str, file_name: &str) -> Result<Self, SceneError> {
        Self::parse_upon(text, file_name, &find)
    }

    /// Reads a scene whose base is what `find` gives for its name.
    /// An error says the file, the line, the key, and what is allowed there; the file may be the base.
    pub fn parse_upon(text: &str, file_name: &str, find: Find<'_>) -> Result<Self, SceneError> {
        let sources = Sources::read(text, file_name, find)?;
        let table = sources.with_defaults()?;
        let scene = Self::deserialize(toml::Deserializer::from(table.clone()))
            .map_err(|error| sources.of_toml(error.span().unwrap_or(0..0), error.message()))?;
        check::check(&scene, table.get_ref()).map_err(|wrong| sources.wrong(wrong.span, wrong.what))?;
        Ok(scene)
    }

    /// A scene and what it stands on as one table, unchecked: for whoever draws its numbers anew.
    pub fn table(text: &str, file_name: &str) -> Result<toml::Table, SceneError> {
        let sources = Sources::read(text, file_name, &find)?;
        toml::Table::deserialize(toml::Deserializer::from(sources.merged()?))
            .map_err(|error| sources.of_toml(error.span().unwrap_or(0..0), error.message()))
    }

    /// The motor's dead time, s, and the force that it adds unloaded, N/s: 0 without an object. Each pad takes half of the way.
    pub fn motor(&self) -> [f64; 2] {
        let stiffness = self.object.as_ref().map_or(0.0, |object| object.get_ref().stiffness_n_per_mm.get());
        [self.gripper.dead_time_ms.get() / 1e3, self.gripper.speed_mm_s.get() * stiffness / 2.0]
    }

    /// Half the width of the force sensor's hysteresis, as a part of the force.
    pub const fn hysteresis(&self) -> f64 {
        self.fsr.hysteresis.get()
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
            let at_s = lift.at_s.get();
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

/// The smallest scene, with every sensor; `first` goes before its tables, `then` after them.
#[cfg(test)]
pub(crate) fn plain(first: &str, then: &str) -> SceneFile {
    let text = format!(
        "name = 'n'\ntitle = 't'\nfrom = 'assumed'\nduration_s = 2\nslip_floor_mm_s = 1\n{first}[robot]\n[skin]\n\
         [contact]\nmu_s = 0.5\nmu_d = 0.4\npad_length_mm = 18\npitch_mm = 1\n{then}"
    );
    SceneFile::parse(&text, "plain").unwrap_or_else(|error| panic!("{error}"))
}
