//! What a scene file is made of: one struct for each kind of table in it.
//!
//! `docs/scenes.md` explains every key to whoever writes one. Sections of the hand and its sensors have defaults, whose
//! sources stand in `file::defaults`; the world has none, it is what the scene is about.

mod arm;
mod contact;
mod gripper;
mod head;
mod mishap;
mod object;
mod person;
mod pull;
mod sensor;

pub use arm::{Arm, Move, Press, Robot, Sweep, Swing};
pub use contact::{Contact, Level, Wet};
pub use gripper::Gripper;
pub use head::Photoelastic;
pub use mishap::{ElectrodeLift, FaultKind, Hum, Jam, Knock, SensorFault, Vibrator};
pub use object::{Fill, Object, Pitch, Table};
pub use person::{Command, CommandKind, Intent, Muscle};
pub use pull::Pull;
pub use sensor::{Array, Camera, Fsr, Myo, Pvdf, Skin, Strain};
