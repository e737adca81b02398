//! Where rmw_zenoh looks: a topic's key, an entity's liveliness token and id, and what is attached to each message.

use xxhash_rust::xxh3::xxh3_128;

use crate::message::Message;

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
    fn hash<M: Message>(self) -> String {
        if self.humble { NO_HASH.to_owned() } else { M::type_hash() }
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
    Subscription,
}

/// The key of a topic: `0/left/joint_states/sensor_msgs::msg::dds_::JointState_/RIHS01_...`.
pub fn topic<M: Message>(domain: Domain, name: &str) -> String {
    format!("{}/{}/{}/{}", domain.number, name.trim_matches('/'), M::dds_name(), domain.hash::<M>())
}

impl Node {
    pub fn token(&self) -> String {
        let Self { domain: Domain { number, .. }, session, id, name } = self;
        format!("@ros2_lv/{number}/{session}/{id}/{id}/NN/%/%/{name}")
    }

    /// The token of one of its topics, `depth` messages of which are kept; the rest is rmw_zenoh's default: reliable, volatile.
    pub fn endpoint<M: Message>(&self, role: Role, entity: u32, topic: &str, depth: u32) -> String {
        let Self { domain: Domain { number, .. }, session, id, name } = self;
        let role = match role {
            Role::Publisher => "MP",
            Role::Subscription => "MS",
        };
        let topic = topic.replace('/', "%");
        let (kind, hash) = (M::dds_name(), self.domain.hash::<M>());
        format!(
            "@ros2_lv/{number}/{session}/{id}/{entity}/{role}/%/%/{name}/{topic}/{kind}/{hash}/::,{depth}:,:,:,,"
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
