//! Held against what others gave: type hashes as ROS 2 Jazzy publishes them, and payloads, ids and attachments that rosbags 0.11.9,
//! xxhash and eclipse-zenoh 1.10.2 wrote.

use proptest::prelude::*;
use tenax_ros2::cdr;
use tenax_ros2::describe::{Definition, hash};
use tenax_ros2::key::{self, Attachment, Domain, Node, Role, gid};
use tenax_ros2::message::{
    DEFINITIONS, DiagnosticArray, DiagnosticStatus, GoalStatusArray, GripperCommand, Header, JointState,
    KeyValue, Margin, Message, Slip, Tactile, Time, Word,
};

fn head() -> Header {
    Header { stamp: Time::of_ns(1_700_000_001_250_000_002), frame_id: "left".to_owned() }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn both_ways<M: Message + PartialEq + std::fmt::Debug>(message: &M, expected: &str) {
    let payload = cdr::payload(message).unwrap();
    assert_eq!(hex(&payload), expected, "{}", M::NAME);
    assert_eq!(cdr::message::<M>(&payload).as_ref(), Some(message));
    for cut in 0..payload.len() {
        assert_eq!(cdr::message::<M>(&payload[..cut]), None, "{} cut at {cut}", M::NAME);
    }
}

#[test]
fn type_hashes_are_the_published_ones() {
    let published = [
        ("builtin_interfaces/msg/Time", "b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197"),
        ("std_msgs/msg/Header", "f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01"),
        (JointState::NAME, "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"),
        (Word::NAME, "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"),
        ("diagnostic_msgs/msg/KeyValue", "d68081eaa540288c5440753baecef0c4e16e81a5f78ad68902ded5100413bb42"),
        (
            "diagnostic_msgs/msg/DiagnosticStatus",
            "b0e3e692ea2d54a8af2f4ef1930e81556a2db55216b771f8a7d2724ed47bf0e4",
        ),
        (DiagnosticArray::NAME, "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"),
        (GripperCommand::NAME, "57eb8f326c9889ca8bb34ead82cc94cc09bf6bc5c3b6c09546dca3a00b589890"),
        (Tactile::NAME, "9433f7d572f1804ddb1c7d3709794607394a1bfbd1cba9b31d0551f2b551cdb2"),
        (Slip::NAME, "c15a97cc44f874dc30c13dadf9169353511ddb7c941ced2a41bbc72d496daa0c"),
        (Margin::NAME, "1672a98bf9b50e1e49796b4dcc6a9dfa93ddaabfc2cf3a33bac08fae943ed763"),
        ("action_msgs/srv/CancelGoal", "573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a"),
        (GoalStatusArray::NAME, "6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e"),
        // An action that everybody has: what is derived from ours is derived alike.
        (
            "example_interfaces/action/Fibonacci_SendGoal",
            "d1a57fb2a4afe8c21e34fb10db206f16ce6729b28531141472df92277c55b557",
        ),
        (
            "example_interfaces/action/Fibonacci_GetResult",
            "1b0de0d5d29dc955d92f546706568428632771db13ec84c15ec1c1a59f424a57",
        ),
        (
            "example_interfaces/action/Fibonacci_FeedbackMessage",
            "c1de71afd52e49a89c53d8262366884185bc0a02f78ce051c4e46b0a7fe59bb2",
        ),
    ];
    let fibonacci =
        [("Goal", "int32 order"), ("Result", "int32[] sequence"), ("Feedback", "int32[] sequence")];
    let names = fibonacci.map(|(end, _)| format!("example_interfaces/action/Fibonacci_{end}"));
    let fibonacci = names.iter().zip(fibonacci).map(|(name, (_, text))| (name.as_str(), text));
    let known: Vec<Definition> = DEFINITIONS.into_iter().chain(fibonacci).collect();
    for (name, expected) in published {
        assert_eq!(hash(name, &known), Some(format!("RIHS01_{expected}")), "{name}");
    }
    assert!(DEFINITIONS.iter().all(|(name, _)| hash(name, &DEFINITIONS).is_some()));
    assert_eq!(hash("std_msgs/msg/String", &[]), None);
}

#[test]
fn payloads_are_those_of_another_writer() {
    let joint = JointState {
        header: head(),
        name: vec!["left_grip".to_owned()],
        effort: vec![7.4],
        ..JointState::default()
    };
    both_ways(
        &joint,
        "0001000001f1536582b2e60e050000006c65667400000000010000000a0000006c6566745f67726970000000000000000000000001000000000000009a99999999991d40",
    );
    both_ways(
        &GripperCommand { position: 0.0, max_effort: 12.5 },
        "0001000000000000000000000000000000002940",
    );
    let value = KeyValue { key: "frames lost".to_owned(), value: "3".to_owned() };
    let status = DiagnosticStatus {
        level: 1,
        name: "left: fingertip".to_owned(),
        message: "running".to_owned(),
        hardware_id: "0000".to_owned(),
        values: vec![value],
    };
    both_ways(
        &DiagnosticArray { header: head(), status: vec![status] },
        "0001000001f1536582b2e60e050000006c656674000000000100000001000000100000006c6566743a2066696e676572746970000800000072756e6e696e6700050000003030303000000000010000000c0000006672616d6573206c6f737400020000003300",
    );
    let tactile = Tactile {
        header: head(),
        forces_valid: true,
        load: 7.4,
        shear_x: -0.5,
        shear_y: 0.25,
        samples: vec![1, 2, 16_383],
        films: vec![7],
    };
    both_ways(
        &tactile,
        "0001000001f1536582b2e60e050000006c65667400010000000000009a99999999991d40000000000000e0bf000000000000d03f0300000001000200ff3f0000010000000700",
    );
    let slip = Slip {
        header: head(),
        mode: 3,
        slipping: true,
        said: 5,
        believed: 4,
        acted: 1,
        vibration_mv: 300,
        wearer_active: false,
        line_may_command: true,
    };
    both_ways(&slip, "0001000001f1536582b2e60e050000006c6566740003010504012c010001");
    let margin =
        Margin { header: head(), valid: true, margin: 1.5, ratio: 0.21, limit: 0.3, shear_angle: 0.5 };
    both_ways(
        &margin,
        "0001000001f1536582b2e60e050000006c6566740001000000000000000000000000f83fe17a14ae47e1ca3f333333333333d33f000000000000e03f",
    );
}

#[test]
fn keys_and_tokens_are_rmw_zenohs() {
    let jazzy = |number| Domain { number, humble: false };
    // As a ROS 2 node was heard to publish.
    let expected = "73/es_js_capture/sensor_msgs::msg::dds_::JointState_/\
                    RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e";
    assert_eq!(key::key(jazzy(73), "/es_js_capture", JointState::NAME), expected);
    assert!(
        key::key(jazzy(0), "/left/slip", Slip::NAME)
            .starts_with("0/left/slip/tenax_msgs::msg::dds_::Slip_/RIHS01_")
    );
    let humble = Domain { number: 0, humble: true };
    let expected = "0/left/slip/tenax_msgs::msg::dds_::Slip_/TypeHashNotSupported";
    assert_eq!(key::key(humble, "/left/slip", Slip::NAME), expected);
    // The examples of rmw_zenoh's design, with another type.
    let session = "8b20917502ee955ac4476e0266340d5c".to_owned();
    let node = Node { domain: jazzy(2), session, id: 0, name: "talker".to_owned() };
    assert_eq!(node.token(), "@ros2_lv/2/8b20917502ee955ac4476e0266340d5c/0/0/NN/%/%/talker");
    let expected = "@ros2_lv/2/8b20917502ee955ac4476e0266340d5c/0/10/MP/%/%/talker/%chatter/\
                    sensor_msgs::msg::dds_::JointState_/\
                    RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e/::,10:,:,:,,";
    assert_eq!(node.endpoint(Role::Publisher, 10, "/chatter", JointState::NAME), expected);
    let heard = node.endpoint(Role::Subscription, 11, "/left/gripper_command", GripperCommand::NAME);
    assert!(
        heard.contains("/0/11/MS/%/%/talker/%left%gripper_command/control_msgs::msg::dds_::GripperCommand_/")
    );
}

#[test]
fn ids_and_attachments_are_those_of_the_other_writers() {
    let token = "@ros2_lv/2/8b20917502ee955ac4476e0266340d5c/0/10/MP/%/%/talker/%chatter/std_msgs::msg::dds_::String_/\
                 RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18/::,7:,:,:,,";
    assert_eq!(hex(&gid(token)), "ac170f31eadcd9ff0cd86d7a17907d1c");
    let attachment =
        Attachment { sequence: 3, time_ns: 1_700_000_001_250_000_002, gid: std::array::from_fn(|n| n as u8) };
    assert_eq!(
        hex(&attachment.bytes()),
        "0300000000000000827cab80fe9c971710000102030405060708090a0b0c0d0e0f"
    );
}

#[test]
fn names_are_those_that_ros_takes() {
    for name in ["left", "left_hand", "L2"] {
        assert!(key::is_name(name), "{name}");
    }
    for name in ["", "2left", "_left", "left/x", "left hand", "a__b", "hand*", "hånd"] {
        assert!(!key::is_name(name), "{name}");
    }
}

proptest! {
    #[test]
    fn whatever_comes_is_a_message_or_is_none(bytes in prop::collection::vec(any::<u8>(), 0..200), little in any::<bool>()) {
        let payload = [&[0, u8::from(little), 0, 0][..], &bytes].concat();
        let _command = cdr::message::<GripperCommand>(&payload);
        let _joint = cdr::message::<JointState>(&payload);
        let _diagnostics = cdr::message::<DiagnosticArray>(&payload);
        let _tactile = cdr::message::<Tactile>(&payload);
    }

    #[test]
    fn what_is_written_is_read(name in "[a-z]{0,20}", effort in prop::collection::vec(-1e6..1e6, 0..5), ns in any::<u64>()) {
        let header = Header { stamp: Time::of_ns(ns), frame_id: name.clone() };
        let joint = JointState { header, name: vec![name], effort, ..JointState::default() };
        let payload = cdr::payload(&joint).unwrap();
        prop_assert_eq!(cdr::message::<JointState>(&payload), Some(joint));
    }
}
