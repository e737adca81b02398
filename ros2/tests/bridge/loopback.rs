//! A served scene, the bridge, and a second session as a ROS 2 node would have it.

mod common;

use std::net::TcpListener;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use common::Served;
use serde::Serialize;
use serde::de::DeserializeOwned;
use tenax_frames::link::Board;
use tenax_ros2::bridge::hand::{Hand, bridge};
use tenax_ros2::bridge::network::{Place, open};
use tenax_ros2::key::{Attachment, Domain, key};
use tenax_ros2::message::{
    CancelResponse, DiagnosticArray, Feedback, GoalId, GoalInfo, GoalStatusArray, Gripper, GripperCommand,
    JointState, Message, ParallelGripper, ResultResponse, SendGoal, SendGoalResponse, Slip, Word,
};
use tenax_ros2::{cdr, key as keys};
use zenoh::{Session, Wait};
use zenoh_ext::{AdvancedSubscriberBuilderExt, HistoryConfig};

const DOMAIN: Domain = Domain { number: 7, humble: false };
const WITHIN: Duration = Duration::from_secs(10);

/// A gripper that touches nothing: at its start the board consents.
const CONSENTING: &str = include_str!("open.toml");

struct Ros<'a> {
    session: &'a Session,
}

impl Ros<'_> {
    fn hear<M: Message + Send + 'static>(&self, name: &str) -> Receiver<(M, Attachment)> {
        self.hear_kind(name, M::NAME, None)
    }

    /// As a subscription that is transient local: the message before it is heard, too.
    fn latched<M: Message + Send + 'static>(&self, name: &str) -> Receiver<(M, Attachment)> {
        let history = HistoryConfig::default().detect_late_publishers().max_samples(1);
        self.hear_kind(name, M::NAME, Some(history))
    }

    fn hear_kind<M: DeserializeOwned + Send + 'static>(
        &self,
        name: &str,
        kind: &str,
        history: Option<HistoryConfig>,
    ) -> Receiver<(M, Attachment)> {
        let (told, hears) = channel();
        let declared = self.session.declare_subscriber(key(DOMAIN, name, kind)).callback(move |sample| {
            let message = cdr::message::<M>(&sample.payload().to_bytes()).expect("it decodes");
            let attached = sample.attachment().expect("rmw_zenoh drops what has none").to_bytes();
            let _gone = told.send((message, Attachment::of(&attached).expect("33 bytes")));
        });
        match history {
            None => declared.background().wait().unwrap(),
            Some(history) => declared.advanced().history(history).background().wait().unwrap(),
        }
        hears
    }

    /// A request as rmw_zenoh's client sends it: all complete servers, its number and its id attached.
    fn ask<A: DeserializeOwned>(&self, name: &str, kind: &str, request: &impl Serialize) -> A {
        let attached = Attachment { sequence: 7, time_ns: 1, gid: [9; 16] };
        let replies = self.session.get(key(DOMAIN, name, kind)).payload(cdr::payload(request).unwrap());
        let replies = replies.attachment(attached.bytes()).target(zenoh::query::QueryTarget::AllComplete);
        let reply =
            replies.timeout(WITHIN).wait().unwrap().recv().unwrap_or_else(|_| panic!("{name}: silence"));
        let sample = reply.into_result().unwrap();
        let own =
            Attachment::of(&sample.attachment().expect("rmw_zenoh drops what has none").to_bytes()).unwrap();
        assert!(own.time_ns > 1 && (own.sequence, own.gid) == (7, [9; 16]), "{own:?}");
        cdr::message(&sample.payload().to_bytes()).expect("it decodes")
    }

    fn goal<G: Serialize>(&self, action: &str, kind: &str, goal_id: GoalId, goal: G) -> bool {
        let (name, kind) = (format!("/left/{action}/_action/send_goal"), format!("{kind}_SendGoal"));
        self.ask::<SendGoalResponse>(&name, &kind, &SendGoal { goal_id, goal }).accepted
    }

    fn result<R: DeserializeOwned>(&self, action: &str, kind: &str, goal_id: GoalId) -> ResultResponse<R> {
        self.ask(&format!("/left/{action}/_action/get_result"), &format!("{kind}_GetResult"), &goal_id)
    }

    fn cancel(&self, goal_id: GoalId) -> (i8, usize) {
        let asked = GoalInfo { goal_id, ..GoalInfo::default() };
        let name = "/left/gripper_cmd/_action/cancel_goal";
        let answer: CancelResponse = self.ask(name, "action_msgs/srv/CancelGoal", &asked);
        (answer.return_code, answer.goals_canceling.len())
    }

    fn grip(&self, position: f64, max_effort: f64) {
        let payload = cdr::payload(&GripperCommand { position, max_effort }).unwrap();
        self.session.put(key(DOMAIN, "/left/gripper_command", GripperCommand::NAME), payload).wait().unwrap();
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
        assert_eq!(keys::gid(joint), attached.gid, "the id is its token's");
        assert_eq!(
            tokens.len(),
            18,
            "a node, six topics and the one it hears, five of each action: {tokens:?}"
        );
    });
}

#[test]
fn with_consent_a_command_closes_to_its_force_and_opens_again() {
    with(CONSENTING, |ros| {
        let (joints, slip) = (ros.hear::<JointState>("/left/joint_states"), ros.hear::<Slip>("/left/slip"));
        let diagnostics = ros.hear::<DiagnosticArray>("/diagnostics");
        let object = ros.latched::<Word>("/left/object");
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

const GRIPPER: &str = "control_msgs/action/GripperCommand";
const PARALLEL: &str = "control_msgs/action/ParallelGripperCommand";

#[test]
fn a_goal_is_taken_fed_back_cancelled_and_ends_with_its_result() {
    with(CONSENTING, |ros| {
        let slip = ros.hear::<Slip>("/left/slip");
        wait_for(&slip, "it never consents", |slip| slip.line_may_command);
        let feedback = format!("{GRIPPER}_FeedbackMessage");
        let feedback =
            ros.hear_kind::<Feedback<Gripper>>("/left/gripper_cmd/_action/feedback", &feedback, None);
        let close = GripperCommand { position: 0.0, max_effort: 5.0 };
        assert!(!ros.goal(
            "gripper_cmd",
            GRIPPER,
            [9; 16],
            GripperCommand { position: f64::NAN, max_effort: 1.0 }
        ));

        assert!(ros.goal("gripper_cmd", GRIPPER, [1; 16], close));
        assert_eq!([ros.cancel([8; 16]), ros.cancel([1; 16]), ros.cancel([1; 16])], [(2, 0), (0, 1), (3, 0)]);
        assert_eq!(ros.result::<Gripper>("gripper_cmd", GRIPPER, [1; 16]).status, 5);
        assert_eq!(ros.result::<Gripper>("gripper_cmd", GRIPPER, [8; 16]).status, 0);

        assert!(ros.goal("gripper_cmd", GRIPPER, [2; 16], close));
        assert!(!ros.goal("gripper_cmd", GRIPPER, [2; 16], close), "an id is taken once");
        let fed =
            wait_for(&feedback, "no feedback", |fed| fed.goal_id == [2; 16] && fed.feedback.position > 0.0);
        assert!(!fed.feedback.reached_goal, "{fed:?}");
        let ResultResponse { status, result } = ros.result::<Gripper>("gripper_cmd", GRIPPER, [2; 16]);
        assert!(status == 4 && result.stalled && !result.reached_goal, "{status}: {result:?}");
        assert!(result.effort >= 5.0 && result.position > 0.0, "{result:?}");

        // Who comes now still hears how all goals ended.
        let told = ros.latched::<GoalStatusArray>("/left/gripper_cmd/_action/status");
        let told = wait_for(&told, "nothing is kept", |_| true).status_list;
        assert_eq!(
            told.iter().map(|(info, status)| (info.goal_id[0], *status)).collect::<Vec<_>>(),
            [(1, 5), (2, 4)]
        );

        let opened = JointState { position: vec![0.05], ..JointState::default() };
        assert!(ros.goal("parallel_gripper_cmd", PARALLEL, [3; 16], opened));
        let ResultResponse { status, result } =
            ros.result::<ParallelGripper>("parallel_gripper_cmd", PARALLEL, [3; 16]);
        assert!(status == 4 && result.reached_goal && !result.stalled, "{status}: {result:?}");
        assert!(result.state.effort[0] < 0.3, "{result:?}");
    });
}

#[test]
fn a_goal_without_consent_is_aborted() {
    with("glass", |ros| {
        let joints = ros.hear::<JointState>("/left/joint_states");
        wait_for(&joints, "it holds nothing", |joints| force(joints) > 7.0);
        assert!(ros.goal(
            "gripper_cmd",
            GRIPPER,
            [1; 16],
            GripperCommand { position: 0.05, max_effort: 0.0 }
        ));
        assert_eq!(ros.result::<Gripper>("gripper_cmd", GRIPPER, [1; 16]).status, 6);
        assert!(newest(&joints) > 7.0);
    });
}
