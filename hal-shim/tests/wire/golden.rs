//! `python/tenax/wire.json` follows from the types of the messages: the types, and the bytes of a message of each kind.
//!
//! A changed byte would let an older monitor read nonsense: the file is only written when [`VERSION`] is above its own. The test fails
//! once after it has written, so that a person looks at the change.

use std::fmt::Debug;
use std::fs;

use postcard_schema::Schema;
use postcard_schema::schema::DataModelType;
use serde::Serialize;
use serde::de::DeserializeOwned;
use tenax_hal_shim::channel::{PVDF_COUNT, SAMPLE_MAX};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{Down, FRAME_MAX, Raw, Receiver, SCHEMA, TickRecord, Up, VERSION, encode};
use tenax_hal_shim::words::DriveSource;

use crate::schema::{Types, messages};

const JSON: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../python/tenax/wire.json");

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The frames of a message of each kind, out of its type; each is read, and written as it was.
fn frames<T: Schema + Serialize + DeserializeOwned + Debug>(direction: &str, lines: &mut Vec<String>) {
    let DataModelType::Enum(variants) = T::SCHEMA.ty else { panic!("{direction} is no enum") };
    for (number, bytes) in messages(T::SCHEMA) {
        let message: T = postcard::from_bytes(&bytes).unwrap_or_else(|error| {
            panic!("{direction} {}: {error}: {}", variants[number].name, hex(&bytes))
        });
        let mut buffer = [0; FRAME_MAX];
        let frame = encode(0x1234, &message, &mut buffer).expect("it fits a frame");
        let mut receiver = Receiver::new();
        let received =
            frame.iter().find_map(|&byte| receiver.push::<T>(byte)).expect("whole").expect("valid").message;
        assert_eq!(postcard::to_allocvec(&received).unwrap(), bytes, "{message:?}");
        lines.push(format!("[\"{direction}\", \"{}\", \"{}\"]", variants[number].name, hex(frame)));
    }
}

/// A tick and a frame have places of their own for their fields.
fn packed(lines: &mut Vec<String>) {
    let s1 = DetectorSet::only(DetectorId::S1);
    let tick = TickRecord {
        vibration: 500,
        outputs: [-128, 64],
        said: DetectorSet::ALL,
        believed: s1.with(DetectorId::S2, true),
        acted: s1,
        drive: MotorDrive::Close(Duty::FULL),
        source: DriveSource::Reflex,
    };
    lines.push(format!("[\"tick\", \"\", \"{}\"]", hex(&postcard::to_allocvec(&tick).unwrap())));
    let mut raw = Raw::default();
    for n in 0..5 {
        raw.put(&Frame {
            sequence: 45 + n,
            valid: n != 3,
            pvdf: core::array::from_fn(|film| (1_001 * n as u16 + 101 * film as u16) % SAMPLE_MAX),
            switch_a: 1_001 * n as u16 + 101 * PVDF_COUNT as u16,
            switch_b: 7,
        });
    }
    lines.push(format!("[\"frames\", \"\", \"{}\"]", hex(&postcard::to_allocvec(&raw).unwrap())));
}

fn json(types: &Types) -> String {
    let mut golden = Vec::new();
    frames::<Down>("Down", &mut golden);
    frames::<Up>("Up", &mut golden);
    packed(&mut golden);
    format!(
        "{{\n\"version\": {VERSION},\n\"schema\": \"{SCHEMA:016x}\",\n\"types\": {{\n{}\n}},\n\"golden\": [\n{}\n]\n}}\n",
        types.json().join(",\n"),
        golden.join(",\n")
    )
}

#[test]
fn the_messages_of_this_version_are_those_that_are_held() {
    let mut types = Types::default();
    types.add(Down::SCHEMA);
    types.add(Up::SCHEMA);
    let now = json(&types);
    let held = fs::read_to_string(JSON).expect("wire.json is part of the repository");
    let version: u8 = held
        .lines()
        .find_map(|line| line.strip_prefix("\"version\": ")?.strip_suffix(',')?.parse().ok())
        .expect("it names its version");
    if held != now {
        let change = held.lines().zip(now.lines()).find(|(held, now)| held != now);
        assert!(
            version < VERSION,
            "version {VERSION} has other bytes than {JSON} holds: give it a new number. First: {change:?}"
        );
        fs::write(JSON, &now).expect("it can be written");
        panic!("{JSON} is of version {VERSION} now: look at it, and run the test again");
    }
}
