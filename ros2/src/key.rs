//! Where rmw_zenoh looks: a topic's key, an entity's liveliness token and id, and what is attached to each message.

use xxhash_rust::xxh3::xxh3_128;

use crate::message::{dds_name, type_hash};

pub const GID: usize = 16;

/// What rmw_zenoh of Humble writes in the place of a type's hash, which that has not.
const NO_HASH: &str = "TypeHashNotSupported";

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Domain {
    pub number: u32,
    /// Of ROS 2 Humble; else of Jazzy or newer.
    pub humble: bool,
}

impl Domain {
    fn hash(self, kind: &str) -> &'static str {
        if self.humble { NO_HASH } else { type_hash(kind) }
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    pub domain: Domain,
    pub session: String,
    pub id: u32,
    pub name: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    Publisher,
    /// Its last message is for those who come later, too: reliable, transient local.
    Latched,
    Subscription,
    Service,
}

/// The key of a topic or a service: `0/left/joint_states/sensor_msgs::msg::dds_::JointState_/RIHS01_...`.
pub fn key(domain: Domain, name: &str, kind: &str) -> String {
    format!("{}/{}/{}/{}", domain.number, name.trim_matches('/'), dds_name(kind), domain.hash(kind))
}

impl Node {
    pub fn token(&self) -> String {
        let Self { domain: Domain { number, .. }, session, id, name } = self;
        format!("@ros2_lv/{number}/{session}/{id}/{id}/NN/%/%/{name}")
    }

    /// The token of one of its topics or services; what it does not say is rmw_zenoh's default: reliable, volatile, ten messages.
    pub fn endpoint(&self, role: Role, entity: u32, name: &str, kind: &str) -> String {
        let Self { domain: Domain { number, .. }, session, id, name: node } = self;
        let (role, qos) = match role {
            Role::Publisher => ("MP", "::,10"),
            Role::Latched => ("MP", ":1:,1"),
            Role::Subscription => ("MS", "::,10"),
            Role::Service => ("SS", "::,10"),
        };
        let (topic, hash) = (name.replace('/', "%"), self.domain.hash(kind));
        format!(
            "@ros2_lv/{number}/{session}/{id}/{entity}/{role}/%/%/{node}/{topic}/{}/{hash}/{qos}:,:,:,,",
            dds_name(kind)
        )
    }
}

pub fn gid(token: &str) -> [u8; GID] {
    // The low half first, each little-endian.
    xxh3_128(token.as_bytes()).to_le_bytes()
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attachment {
    pub sequence: i64,
    pub time_ns: i64,
    pub gid: [u8; GID],
}

impl Attachment {
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let (number, rest) = bytes.split_first_chunk()?;
        let (time, rest) = rest.split_first_chunk()?;
        let gid = rest.strip_prefix(&[GID as u8])?.try_into().ok()?;
        Some(Self { sequence: i64::from_le_bytes(*number), time_ns: i64::from_le_bytes(*time), gid })
    }

    /// Number, time, and the id after its length.
    pub fn bytes(&self) -> Vec<u8> {
        let (number, time) = (self.sequence.to_le_bytes(), self.time_ns.to_le_bytes());
        [&number[..], &time, &[GID as u8], &self.gid].concat()
    }
}

/// Whether a hand may be called so: what ROS allows in a name, and no more.
pub fn is_name(name: &str) -> bool {
    let first = name.bytes().next().is_some_and(|sign| sign.is_ascii_alphabetic());
    first
        && name.len() <= 64
        && !name.contains("__")
        && name.bytes().all(|sign| sign.is_ascii_alphanumeric() || sign == b'_')
}
