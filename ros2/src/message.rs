//! The messages of the bridge. A struct's fields are in the order of its .msg text.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// A type and its hash a line.
const HASHES: &str = include_str!("hashes.txt");

pub trait Message: Serialize + DeserializeOwned {
    const NAME: &'static str;
}

macro_rules! messages {
    ($($message:ident = $name:literal;)*) => {$(
        impl Message for $message {
            const NAME: &'static str = $name;
        }
    )*};
}

messages! {
    JointState = "sensor_msgs/msg/JointState";
    GripperCommand = "control_msgs/msg/GripperCommand";
    Word = "std_msgs/msg/String";
    DiagnosticArray = "diagnostic_msgs/msg/DiagnosticArray";
    Tactile = "tenax_msgs/msg/Tactile";
    Slip = "tenax_msgs/msg/Slip";
    Margin = "tenax_msgs/msg/Margin";
    GoalStatusArray = "action_msgs/msg/GoalStatusArray";
}

/// The hash of a message, a service (`action_msgs/srv/CancelGoal`) or a part of an action (`control_msgs/action/GripperCommand_SendGoal`).
pub fn type_hash(kind: &str) -> &'static str {
    let of = |line: &'static str| line.strip_prefix(kind)?.strip_prefix(' ');
    HASHES.lines().find_map(of).unwrap_or_default()
}

pub fn dds_name(kind: &str) -> String {
    let (path, name) = kind.rsplit_once('/').unwrap_or(("", kind));
    format!("{}::dds_::{name}_", path.replace('/', "::"))
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

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GripperCommand {
    /// Gap, m: 0 closes, more opens.
    pub position: f64,
    /// Grip force to close to, N; 0: until the object is felt, and no further.
    pub max_effort: f64,
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Word {
    pub data: String,
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

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Margin {
    pub header: Header,
    pub valid: bool,
    pub margin: f64,
    pub ratio: f64,
    pub limit: f64,
    pub shear_angle: f64,
}

pub type GoalId = [u8; 16];

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SendGoal<G> {
    pub goal_id: GoalId,
    pub goal: G,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SendGoalResponse {
    pub accepted: bool,
    pub stamp: Time,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResultResponse<R> {
    pub status: i8,
    pub result: R,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Feedback<F> {
    pub goal_id: GoalId,
    pub feedback: F,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct GoalInfo {
    pub goal_id: GoalId,
    pub stamp: Time,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CancelResponse {
    /// 0 cancelled, 2 no such goal, 3 its goal has ended.
    pub return_code: i8,
    pub goals_canceling: Vec<GoalInfo>,
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct GoalStatusArray {
    /// The status of each: 2 executing, 4 succeeded, 5 cancelled, 6 aborted.
    pub status_list: Vec<(GoalInfo, i8)>,
}

/// Result and feedback of the action `GripperCommand`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Gripper {
    /// Gap, m, and grip force, N; no number where the board gives none.
    pub position: f64,
    pub effort: f64,
    /// An object stops the fingers, and the position is reached.
    pub stalled: bool,
    pub reached_goal: bool,
}

/// Result of `ParallelGripperCommand`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ParallelGripper {
    pub state: JointState,
    pub stalled: bool,
    pub reached_goal: bool,
}
