//! The messages of the bridge. A struct's fields are in the order of its .msg text.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::describe::{Definition, hash};

pub const DEFINITIONS: [Definition; 11] = [
    Definition { name: "builtin_interfaces/msg/Time", text: "int32 sec\nuint32 nanosec" },
    Definition { name: "std_msgs/msg/Header", text: "builtin_interfaces/Time stamp\nstring frame_id" },
    Definition {
        name: JointState::NAME,
        text: "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort",
    },
    Definition { name: GripperCommand::NAME, text: "float64 position\nfloat64 max_effort" },
    Definition { name: "diagnostic_msgs/msg/KeyValue", text: "string key\nstring value" },
    Definition {
        name: "diagnostic_msgs/msg/DiagnosticStatus",
        text: "byte level\nstring name\nstring message\nstring hardware_id\nKeyValue[] values",
    },
    Definition { name: Word::NAME, text: "string data" },
    Definition { name: DiagnosticArray::NAME, text: "std_msgs/Header header\nDiagnosticStatus[] status" },
    Definition { name: Tactile::NAME, text: include_str!("../tenax_msgs/msg/Tactile.msg") },
    Definition { name: Slip::NAME, text: include_str!("../tenax_msgs/msg/Slip.msg") },
    Definition { name: Margin::NAME, text: include_str!("../tenax_msgs/msg/Margin.msg") },
];

pub trait Message: Serialize + DeserializeOwned {
    const NAME: &'static str;

    fn type_hash() -> String {
        hash(Self::NAME, &DEFINITIONS).unwrap_or_default()
    }

    fn dds_name() -> String {
        let (path, name) = Self::NAME.rsplit_once('/').unwrap_or(("", Self::NAME));
        format!("{}::dds_::{name}_", path.replace('/', "::"))
    }
}

/// Since 1970.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Time {
    pub sec: i32,
    pub nanosec: u32,
}

impl Time {
    pub fn of_ns(ns: u64) -> Self {
        Self {
            sec: i32::try_from(ns / 1_000_000_000).unwrap_or(i32::MAX),
            nanosec: (ns % 1_000_000_000) as u32,
        }
    }
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    pub stamp: Time,
    pub frame_id: String,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointState {
    pub header: Header,
    pub name: Vec<String>,
    /// Gap, m; without `--range-m` as a part of the hand's range, 0 to 1. Empty while the opening gives no number.
    pub position: Vec<f64>,
    pub velocity: Vec<f64>,
    /// Grip force, N. Empty while the force sensor gives no number.
    pub effort: Vec<f64>,
}

impl Message for JointState {
    const NAME: &'static str = "sensor_msgs/msg/JointState";
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GripperCommand {
    /// Gap, m: 0 closes, more opens.
    pub position: f64,
    /// Grip force to close to, N; 0: until the object is felt, and no further.
    pub max_effort: f64,
}

impl Message for GripperCommand {
    const NAME: &'static str = "control_msgs/msg/GripperCommand";
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Word {
    pub data: String,
}

impl Message for Word {
    const NAME: &'static str = "std_msgs/msg/String";
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeyValue {
    pub key: String,
    pub value: String,
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiagnosticStatus {
    /// 0 well, 1 warning, 2 error, 3 stale.
    pub level: u8,
    pub name: String,
    pub message: String,
    pub hardware_id: String,
    pub values: Vec<KeyValue>,
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiagnosticArray {
    pub header: Header,
    pub status: Vec<DiagnosticStatus>,
}

impl Message for DiagnosticArray {
    const NAME: &'static str = "diagnostic_msgs/msg/DiagnosticArray";
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tactile {
    pub header: Header,
    pub forces_valid: bool,
    pub load: f64,
    pub shear_x: f64,
    pub shear_y: f64,
    pub samples: Vec<u16>,
    pub films: Vec<u16>,
}

impl Message for Tactile {
    const NAME: &'static str = "tenax_msgs/msg/Tactile";
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[allow(clippy::struct_excessive_bools, reason = "a message")]
pub struct Slip {
    pub header: Header,
    pub mode: u8,
    pub slipping: bool,
    pub said: u8,
    pub believed: u8,
    pub acted: u8,
    pub vibration_mv: u16,
    pub wearer_active: bool,
    pub line_may_command: bool,
}

impl Message for Slip {
    const NAME: &'static str = "tenax_msgs/msg/Slip";
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Margin {
    pub header: Header,
    pub valid: bool,
    pub margin: f64,
    pub ratio: f64,
    pub limit: f64,
    pub shear_angle: f64,
}

impl Message for Margin {
    const NAME: &'static str = "tenax_msgs/msg/Margin";
}
