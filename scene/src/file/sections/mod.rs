//! One struct for each kind of table of a scene file.
//!
//! `docs/scenes.md` explains every key. Sections of the hand and its sensors have defaults, whose sources stand in `file::defaults`.

mod mishap;
mod person;
mod sensor;
mod world;

pub use mishap::{ElectrodeLift, FaultKind, Hum, Jam, Knock, SensorFault, Vibrator};
pub use person::{Command, CommandKind, Intent, Muscle};
pub use sensor::{Array, Camera, Fsr, Myo, Photoelastic, Pvdf, Skin, Strain};
pub use world::{
    Arm, Contact, Fill, Gripper, Level, Move, Object, Pitch, Press, Pull, Robot, Sweep, Swing, Table, Wet,
};
