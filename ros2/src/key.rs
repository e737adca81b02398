//! Where rmw_zenoh looks: a topic's key, an entity's liveliness token and id, and what is attached to each message.

use xxhash_rust::xxh3::xxh3_128;

use crate::message::Message;

pub const GID: usize = 16;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    pub domain: u32,
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
pub fn topic<M: Message>(domain: u32, name: &str) -> String {
    format!("{domain}/{}/{}/{}", name.trim_matches('/'), M::dds_name(), M::type_hash())
}

impl Node {
    pub fn token(&self) -> String {
        let Self { domain, session, id, name } = self;
        format!("@ros2_lv/{domain}/{session}/{id}/{id}/NN/%/%/{name}")
    }

    /// The token of one of its topics, `depth` messages of which are kept; the rest is rmw_zenoh's default: reliable, volatile.
    pub fn endpoint<M: Message>(&self, role: Role, entity: u32, topic: &str, depth: u32) -> String {
        let Self { domain, session, id, name } = self;
        let role = match role {
            Role::Publisher => "MP",
            Role::Subscription => "MS",
        };
        let topic = topic.replace('/', "%");
        let (kind, hash) = (M::dds_name(), M::type_hash());
        format!(
            "@ros2_lv/{domain}/{session}/{id}/{entity}/{role}/%/%/{name}/{topic}/{kind}/{hash}/::,{depth}:,:,:,,"
        )
    }
}

/// An entity's id: the hash of its token.
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
