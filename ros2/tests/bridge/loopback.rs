//! A served scene, the bridge, and a second session as a ROS 2 node would have it.

mod common;

use std::net::TcpListener;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use common::Served;
use tenax_frames::link::Board;
use tenax_ros2::bridge::hand::{Hand, bridge};
use tenax_ros2::bridge::network::{Place, open};
use tenax_ros2::key::{Attachment, Domain, topic};
use tenax_ros2::message::{DiagnosticArray, GripperCommand, JointState, Message, Slip, Word};
use tenax_ros2::{cdr, key};
use zenoh::{Session, Wait};

const DOMAIN: Domain = Domain { number: 7, humble: false };
const WITHIN: Duration = Duration::from_secs(10);

/// A gripper that touches nothing: at its start the board consents.
const CONSENTING: &str = include_str!("open.toml");

struct Ros<'a> {
    session: &'a Session,
}

impl Ros<'_> {
    fn hear<M: Message + Send + 'static>(&self, name: &str) -> Receiver<(M, Attachment)> {
        let (told, hears) = channel();
        let declared = self.session.declare_subscriber(topic::<M>(DOMAIN, name)).callback(move |sample| {
            let message = cdr::message::<M>(&sample.payload().to_bytes()).expect("it decodes");
            let attached = sample.attachment().expect("rmw_zenoh drops what has none").to_bytes();
            let attached: [u8; 33] = attached[..].try_into().expect("33 bytes");
            let number = |at: usize| i64::from_le_bytes(attached[at..at + 8].try_into().unwrap());
            let gid = attached[17..].try_into().unwrap();
            let _gone = told.send((message, Attachment { sequence: number(0), time_ns: number(8), gid }));
        });
        declared.background().wait().unwrap();
        hears
    }

    fn grip(&self, position: f64, max_effort: f64) {
        let payload = cdr::payload(&GripperCommand { position, max_effort }).unwrap();
        self.session.put(topic::<GripperCommand>(DOMAIN, "/left/gripper_command"), payload).wait().unwrap();
    }
}

/// A bridge to this scene in the middle of two sessions, and what is asked of it.
fn with(scene: &str, ask: impl FnOnce(&Ros)) {
    let served = Served::start(scene);
    let free = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let at = format!("tcp/{free}");
    let own = open(&Place::RouterHere(at.clone())).unwrap();
    let others = open(&Place::At(at)).unwrap();
    let board = Board::at(served.line.parse().unwrap());
    let hand = Hand { name: "left".to_owned(), board, range_m: 0.1 };
    let stop = AtomicBool::new(false);
    thread::scope(|scope| {
        let bridging = scope.spawn(|| bridge(&own, DOMAIN, 0, &hand, &stop));
        let asked = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| ask(&Ros { session: &others })));
        stop.store(true, Ordering::Relaxed);
        bridging.join().unwrap().unwrap();
        if let Err(panic) = asked {
            std::panic::resume_unwind(panic);
        }
    });
}

fn wait_for<M>(hears: &Receiver<(M, Attachment)>, what: &str, is: impl Fn(&M) -> bool) -> M {
    let began = Instant::now();
    loop {
        let (message, _) = hears.recv_timeout(WITHIN).unwrap_or_else(|_| panic!("silence: {what}"));
        if is(&message) {
            return message;
        }
        assert!(began.elapsed() < WITHIN, "{what}");
    }
}

fn said_of_command(message: &DiagnosticArray) -> &str {
    &message.status[0].values[0].value
}

fn force(message: &JointState) -> f64 {
    message.effort.first().copied().unwrap_or_default()
}

fn newest(hears: &Receiver<(JointState, Attachment)>) -> f64 {
    while hears.try_recv().is_ok() {}
    force(&hears.recv_timeout(WITHIN).unwrap().0)
}

#[test]
fn every_joint_state_arrives_in_order_and_the_graph_knows_the_hand() {
    with(CONSENTING, |ros| {
        let joints = ros.hear::<JointState>("/left/joint_states");
        let (first, attached) = joints.recv_timeout(WITHIN).unwrap();
        assert_eq!(
            (first.name.as_slice(), first.header.frame_id.as_str()),
            (&["left_grip".to_owned()][..], "left")
        );
        for n in 1..=100 {
            let (_, next) = joints.recv_timeout(WITHIN).unwrap();
            assert_eq!((next.sequence, next.gid), (attached.sequence + n, attached.gid));
            assert!(next.time_ns > attached.time_ns);
        }
        let tokens = ros.session.liveliness().get("@ros2_lv/7/**").wait().unwrap();
        let tokens: Vec<String> =
            tokens.into_iter().map(|reply| reply.result().unwrap().key_expr().to_string()).collect();
        assert!(tokens.iter().any(|token| token.ends_with("/NN/%/%/tenax_left")), "{tokens:?}");
        let joint = tokens.iter().find(|token| token.contains("%left%joint_states")).unwrap();
        assert_eq!(key::gid(joint), attached.gid, "the id is its token's");
        assert_eq!(tokens.len(), 8, "a node, six topics and the one it hears: {tokens:?}");
    });
}

#[test]
fn with_consent_a_command_closes_to_its_force_and_opens_again() {
    with(CONSENTING, |ros| {
        let (joints, slip) = (ros.hear::<JointState>("/left/joint_states"), ros.hear::<Slip>("/left/slip"));
        let diagnostics = ros.hear::<DiagnosticArray>("/diagnostics");
        let object = ros.hear::<Word>("/left/object");
        wait_for(&slip, "it never consents", |slip| slip.line_may_command);
        wait_for(&object, "it holds something", |object| object.data == "none");
        let gap = |joints: &JointState| joints.position.first().copied().unwrap_or(f64::NAN);
        let open_m = gap(&wait_for(&joints, "no position", |joints| !joints.position.is_empty()));
        assert!((0.02..=0.1).contains(&open_m), "{open_m} m");
        wait_for(&joints, "it holds something", |joints| force(joints) < 0.3);
        ros.grip(0.0, 5.0);
        wait_for(&joints, "it does not close", |joints| force(joints) >= 5.0);
        wait_for(&diagnostics, "not said", |said| said_of_command(said) == "the force is reached");
        let held = newest(&joints);
        assert!((4.0..7.0).contains(&held), "{held} N");
        wait_for(&joints, "it is as open as before", |joints| gap(joints) < open_m - 0.005);
        wait_for(&object, "it holds nothing", |object| object.data == "held");
        ros.grip(0.05, 0.0);
        wait_for(&joints, "it does not open", |joints| force(joints) < 0.3);
        wait_for(&object, "it is not let go of", |object| object.data == "none");
    });
}

#[test]
fn without_consent_a_command_is_refused_and_moves_nothing() {
    with("glass", |ros| {
        let (joints, slip) = (ros.hear::<JointState>("/left/joint_states"), ros.hear::<Slip>("/left/slip"));
        let diagnostics = ros.hear::<DiagnosticArray>("/diagnostics");
        wait_for(&slip, "it consents", |slip| !slip.line_may_command);
        wait_for(&joints, "it holds nothing", |joints| force(joints) > 7.0);
        for (position, effort) in [(0.05, 0.0), (0.0, 30.0), (0.0, 0.0)] {
            let before = newest(&joints);
            ros.grip(position, effort);
            wait_for(&diagnostics, "not said", |said| {
                said_of_command(said).starts_with("refused by the board")
            });
            let after = newest(&joints);
            assert!((after - before).abs() < 0.5, "{before} N before, {after} N after");
            // So that the next one's refusal is its own.
            ros.grip(f64::NAN, 0.0);
            wait_for(&diagnostics, "not said", |said| said_of_command(said).contains("no number"));
        }
    });
}
