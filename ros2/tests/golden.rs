//! Held against what others gave: payloads, ids and attachments that rosbags 0.11.9, xxhash and eclipse-zenoh 1.10.2 wrote.

use proptest::prelude::*;
use tenax_ros2::cdr;
use tenax_ros2::key::{self, Attachment, Domain, Node, Role, gid};
use tenax_ros2::message::{
    DiagnosticArray, DiagnosticStatus, GoalStatusArray, GripperCommand, Header, JointState, KeyValue, Margin,
    Message, Slip, Tactile, Time, Word, type_hash,
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

/// Fields that change have another hash: `ros2 topic info --verbose` of a package that is built with them shows it.
#[test]
fn every_message_has_a_hash_and_ours_are_of_these_fields() {
    let is_hash = |kind: &str| type_hash(kind).strip_prefix("RIHS01_").is_some_and(|hex| hex.len() == 64);
    let names = [JointState::NAME, GripperCommand::NAME, Word::NAME, DiagnosticArray::NAME];
    let own = [Tactile::NAME, Slip::NAME, Margin::NAME, GoalStatusArray::NAME, "action_msgs/srv/CancelGoal"];
    assert!(names.into_iter().chain(own).all(is_hash));
    for action in ["GripperCommand", "ParallelGripperCommand"] {
        for part in ["SendGoal", "GetResult", "FeedbackMessage"] {
            assert!(is_hash(&format!("control_msgs/action/{action}_{part}")), "{action} {part}");
        }
    }
    assert_eq!(type_hash("std_msgs/msg/Strin"), "");
    for (text, fields) in [
        (
            include_str!("../tenax_msgs/msg/Tactile.msg"),
            "std_msgs/Header header,bool forces_valid,float64 load,float64 shear_x,float64 shear_y,uint16[] samples,\
             uint16[] films",
        ),
        (
            include_str!("../tenax_msgs/msg/Slip.msg"),
            "std_msgs/Header header,uint8 mode,bool slipping,uint8 said,uint8 believed,uint8 acted,uint16 vibration_mv,\
             bool wearer_active,bool line_may_command",
        ),
        (
            include_str!("../tenax_msgs/msg/Margin.msg"),
            "std_msgs/Header header,bool valid,float64 margin,float64 ratio,float64 limit,float64 shear_angle",
        ),
    ] {
        // A constant is no field.
        let own = text.lines().filter(|line| !line.starts_with('#') && !line.contains('='));
        assert_eq!(own.collect::<Vec<_>>().join(","), fields);
    }
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
