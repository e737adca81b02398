//! A zenoh session with rmw_zenoh's defaults, and the topics of a node in it.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

use crate::cdr;
use crate::key::{self, Attachment, Domain, GID, Node, Role, gid};
use crate::message::Message;
use anyhow::{Context, anyhow, bail};
use serde::Serialize;
use serde::de::DeserializeOwned;
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::Subscriber;
use zenoh::qos::CongestionControl;
use zenoh::query::{Query, Queryable};
use zenoh::{Config, Session, Wait};
use zenoh_ext::{AdvancedPublisher, AdvancedPublisherBuilderExt, CacheConfig};

const ROUTER_WITHIN: Duration = Duration::from_secs(3);
const LOOK_EVERY: Duration = Duration::from_millis(20);

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A peer, as ROS 2's nodes are: it finds them through this router.
    At(String),
    /// The router itself, which listens here.
    RouterHere(String),
}

/// Opens a session. Fails, and says what to do, if there is no router, or the place to listen at is taken.
pub fn open(place: &Place) -> anyhow::Result<Session> {
    let mut config = Config::default();
    let mut set = |key: &str, value: &str| {
        config.insert_json5(key, value).map_err(|error| anyhow!("{key} = {value}: {error}"))
    };
    set("scouting/multicast/enabled", "false")?;
    set("timestamping/enabled", "true")?;
    match place {
        Place::At(router) => {
            set("mode", "\"peer\"")?;
            set("connect/endpoints", &format!("[{router:?}]"))?;
            set("connect/timeout_ms", "-1")?;
            set("connect/exit_on_failure", "false")?;
            // Other nodes of this machine come directly; those of others through the router.
            set("listen/endpoints", "[\"tcp/127.0.0.1:0\"]")?;
        }
        Place::RouterHere(at) => {
            set("mode", "\"router\"")?;
            set("listen/endpoints", &format!("[{at:?}]"))?;
        }
    }
    let session = zenoh::open(config).wait().map_err(|error| match place {
        Place::At(router) => anyhow!("cannot connect to the router at {router}: {error}"),
        Place::RouterHere(at) => anyhow!(
            "cannot be the router at {at}: {error}. If another router runs there, leave --router-here out"
        ),
    })?;
    if let Place::At(router) = place {
        let until = SystemTime::now() + ROUTER_WITHIN;
        while session.info().routers_zid().wait().next().is_none() {
            if SystemTime::now() > until {
                let _closed = session.close().wait();
                bail!(
                    "no zenoh router answers at {router}: start one with `ros2 run rmw_zenoh_cpp rmw_zenohd`, or be it, \
                     with --router-here"
                );
            }
            std::thread::sleep(LOOK_EVERY);
        }
    }
    Ok(session)
}

pub fn now_ns() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    u64::try_from(since.as_nanos()).unwrap_or(u64::MAX)
}

pub struct Graph<'a> {
    session: &'a Session,
    node: Node,
    entities: u32,
    tokens: Vec<LivelinessToken>,
}

impl<'a> Graph<'a> {
    /// A node that the others see from now on. `id` is its own in the session.
    pub fn new(session: &'a Session, domain: Domain, id: u32, name: &str) -> anyhow::Result<Self> {
        let node = Node { domain, session: session.zid().to_string(), id, name: name.to_owned() };
        let mut graph = Self { session, node, entities: 0, tokens: Vec::new() };
        graph.live(&graph.node.token())?;
        Ok(graph)
    }

    fn live(&mut self, token: &str) -> anyhow::Result<()> {
        let token = self.session.liveliness().declare_token(token.to_owned()).wait();
        self.tokens.push(token.map_err(|error| anyhow!("{error}"))?);
        Ok(())
    }

    pub fn publisher<M: Message>(&mut self, topic: &str) -> anyhow::Result<Publisher<'a>> {
        self.publishes(Role::Publisher, topic, M::NAME)
    }

    /// `Role::Latched`: who subscribes later hears the last message, too.
    pub fn publishes(&mut self, role: Role, topic: &str, kind: &str) -> anyhow::Result<Publisher<'a>> {
        let token = self.endpoint(role, topic, kind)?;
        let key = key::key(self.node.domain, topic, kind);
        let declared = self.session.declare_publisher(key).congestion_control(CongestionControl::Drop);
        let declared = match role {
            Role::Latched => {
                declared.advanced().cache(CacheConfig::default().max_samples(1)).publisher_detection()
            }
            _ => declared.advanced(),
        };
        let publisher = declared.wait().map_err(|error| anyhow!("{topic}: {error}"))?;
        Ok(Publisher { publisher, gid: gid(&token), sequence: 0 })
    }

    /// A topic to listen to: each message that is one goes to `hear`, on a thread of zenoh's. What is none is skipped.
    pub fn subscription<M: Message>(
        &mut self,
        topic: &str,
        hear: impl Fn(M) + Send + Sync + 'static,
    ) -> anyhow::Result<Subscriber<()>> {
        self.endpoint(Role::Subscription, topic, M::NAME)?;
        let declared = self.session.declare_subscriber(key::key(self.node.domain, topic, M::NAME));
        let declared = declared.callback(move |sample| {
            if let Some(message) = cdr::message(&sample.payload().to_bytes()) {
                hear(message);
            }
        });
        declared.wait().map_err(|error| anyhow!("{topic}: {error}")).context("cannot listen")
    }

    /// A service: each request goes to `ask`, on a thread of zenoh's.
    pub fn service(
        &mut self,
        name: &str,
        kind: &str,
        ask: impl Fn(Request) + Send + Sync + 'static,
    ) -> anyhow::Result<Queryable<()>> {
        self.endpoint(Role::Service, name, kind)?;
        let key = key::key(self.node.domain, name, kind);
        let declared = self.session.declare_queryable(key.clone()).complete(true);
        let declared = declared.callback(move |query| ask(Request { query, key: key.clone() }));
        declared.wait().map_err(|error| anyhow!("{name}: {error}")).context("cannot serve")
    }

    fn endpoint(&mut self, role: Role, name: &str, kind: &str) -> anyhow::Result<String> {
        self.entities += 1;
        // Numbers are the session's: a node has room for a hundred.
        let entity = self.node.id * 100 + self.entities;
        let token = self.node.endpoint(role, entity, name, kind);
        self.live(&token)?;
        Ok(token)
    }
}

/// A request of a service, until it is answered or dropped.
pub struct Request {
    query: Query,
    key: String,
}

impl Request {
    pub fn message<M: DeserializeOwned>(&self) -> Option<M> {
        cdr::message(&self.query.payload()?.to_bytes())
    }

    /// The client knows its request by its own number and id. Without them, or if it has gone, nothing is sent.
    pub fn answer(&self, message: &impl Serialize) {
        let attached = self.query.attachment().and_then(|bytes| Attachment::of(&bytes.to_bytes()));
        if let (Some(attached), Some(payload)) = (attached, cdr::payload(message)) {
            let attached = Attachment { time_ns: now_ns().cast_signed(), ..attached };
            let _gone = self.query.reply(&self.key, payload).attachment(attached.bytes()).wait();
        }
    }
}

pub struct Publisher<'a> {
    publisher: AdvancedPublisher<'a>,
    gid: [u8; GID],
    sequence: i64,
}

impl Publisher<'_> {
    pub fn publish(&mut self, message: &impl Serialize) -> anyhow::Result<()> {
        let payload = cdr::payload(message).context("no CDR")?;
        self.sequence += 1;
        let attachment =
            Attachment { sequence: self.sequence, time_ns: now_ns().cast_signed(), gid: self.gid };
        self.publisher.put(payload).attachment(attachment.bytes()).wait().map_err(|error| anyhow!("{error}"))
    }
}
