//! The wire under garbage, loss and cuts. A failing case prints its seed and is kept by proptest.

mod golden;
mod schema;

use std::fmt::Debug;

use postcard_schema::Schema;
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use serde::Serialize;
use serde::de::DeserializeOwned;
use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::channel::{COUNT, PVDF_COUNT};
use tenax_hal_shim::detector::{DetectorId, DetectorSet, Evidence};
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{
    About, Answer, BAUD, BadFrame, Counters, DETECTORS_MAX, Down, FRAME_MAX, Forces, Identity, KEPT_MAX,
    Last, NetworkState, PIECE_MAX, Raw, Receiver, ResetCause, Restored, SETTINGS_MAX, SETTINGS_PER_ANSWER,
    Senses, Setting, Slow, TickRecord, Up, VERSION, WHY_MAX, encode,
};
use tenax_hal_shim::words::{Code, DriveSource, Fault, GripMode, Kept, Line, NoLesson};

use self::schema::messages;

/// Messages of each kind.
fn any_message<T: Schema + DeserializeOwned + Clone + Debug + 'static>() -> impl Strategy<Value = T> {
    let bytes = messages(T::SCHEMA).into_iter();
    select(bytes.map(|(_, bytes)| postcard::from_bytes(&bytes).expect("a message")).collect::<Vec<T>>())
}

fn answer(answer: Answer) -> Up {
    Up::Answer { of: u16::MAX, frame: u32::MAX, answer }
}

fn receive<T: DeserializeOwned>(bytes: &[u8]) -> Vec<Result<(u16, T), BadFrame>> {
    let mut receiver = Receiver::new();
    bytes
        .iter()
        .filter_map(|&byte| receiver.push::<T>(byte))
        .map(|frame| frame.map(|received| (received.sequence, received.message)))
        .collect()
}

fn frame(sequence: u16, message: &impl Serialize) -> Vec<u8> {
    let mut buffer = [0; FRAME_MAX];
    encode(sequence, message, &mut buffer).unwrap().to_vec()
}

/// Damage to a frame; a zero follows, so that the next frame is whole.
#[derive(Clone, Debug)]
enum Damage {
    Flip(Index, u8),
    Cut(Index),
    Insert(Index, u8),
    Replace(Vec<u8>),
}

fn damage() -> impl Strategy<Value = Option<Damage>> {
    option::of(prop_oneof![
        (any::<Index>(), 0..8u8).prop_map(|(at, bit)| Damage::Flip(at, bit)),
        any::<Index>().prop_map(Damage::Cut),
        any::<(Index, u8)>().prop_map(|(at, byte)| Damage::Insert(at, byte)),
        vec(any::<u8>(), 0..700).prop_map(Damage::Replace),
    ])
}

fn damaged(mut bytes: Vec<u8>, damage: Damage) -> Vec<u8> {
    match damage {
        Damage::Flip(at, bit) => {
            let at = at.index(bytes.len());
            bytes[at] ^= 1 << bit;
        }
        Damage::Cut(at) => bytes.truncate(at.index(bytes.len())),
        Damage::Insert(at, byte) => bytes.insert(at.index(bytes.len()), byte),
        Damage::Replace(others) => bytes = others,
    }
    bytes.push(0);
    bytes
}

/// Every whole frame arrives, and of the damaged ones nothing that was not sent.
fn arrives<T>(sent: Vec<(T, Option<Damage>)>) -> Result<(), TestCaseError>
where
    T: Serialize + DeserializeOwned + Clone + Debug + PartialEq,
{
    let (mut bytes, mut whole) = (Vec::new(), Vec::new());
    for (number, (message, damage)) in (0..).zip(&sent) {
        let frame = frame(number, message);
        match damage.clone() {
            None => {
                whole.push(number);
                bytes.extend(frame);
            }
            Some(damage) => bytes.extend(damaged(frame, damage)),
        }
    }
    let heard: Vec<(u16, T)> = receive(&bytes).into_iter().flatten().collect();
    for (number, message) in &heard {
        prop_assert_eq!(Some(message), sent.get(usize::from(*number)).map(|(message, _)| message));
    }
    prop_assert!(whole.iter().all(|number| heard.iter().any(|(heard, _)| heard == number)), "{heard:?}");
    Ok(())
}

proptest! {
    // Shows L5.
    #[test]
    fn bad_bytes_are_no_message_and_every_whole_frame_arrives(
        to_the_board in vec((any_message::<Down>(), damage()), 1..40),
        from_the_board in vec((any_message::<Up>(), damage()), 1..40),
    ) {
        arrives(to_the_board)?;
        arrives(from_the_board)?;
    }

    // Shows L5.
    #[test]
    fn one_wrong_bit_is_never_another_command(message in any_message::<Down>(), at in any::<Index>(), bit in 0..8u8) {
        for received in receive::<Down>(&damaged(frame(1, &message), Damage::Flip(at, bit))).into_iter().flatten() {
            prop_assert_eq!(received, (1, message));
        }
    }
}

#[test]
fn another_version_is_named() {
    use postcard::ser_flavors::{Cobs, Slice, crc::CrcModifier};
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    let mut buffer = [0; FRAME_MAX];
    let flavor = CrcModifier::new(Cobs::try_new(Slice::new(&mut buffer)).unwrap(), crc.digest());
    // The same envelope as `encode` writes, of the next version and with a message that this version does not know.
    let message = (VERSION + 1, 3_u16, 200_u8, 200_u8);
    let bytes = postcard::serialize_with_flavor::<_, _, &mut [u8]>(&message, flavor).unwrap();
    assert_eq!(receive::<Down>(bytes), [Err(BadFrame::Version(VERSION + 1))]);
}

#[test]
fn an_endless_frame_is_too_long_and_the_next_arrives() {
    let mut bytes = vec![1; 10 * FRAME_MAX];
    bytes.push(0);
    bytes.extend(frame(2, &Down::Ping));
    assert_eq!(receive::<Down>(&bytes), [Err(BadFrame::TooLong), Ok((2, Down::Ping))]);
}

#[test]
fn the_longest_message_fits_a_frame() {
    let longest = TickRecord {
        vibration: u16::MAX,
        outputs: [i8::MIN; 2],
        said: DetectorSet::ALL,
        believed: DetectorSet::ALL,
        acted: DetectorSet::ALL,
        drive: MotorDrive::Close(Duty::FULL),
        source: DriveSource::Reflex,
    };
    let evidence = Evidence {
        confidence_permille: u16::MAX,
        decided_at: u32::MAX,
        raw: i32::MIN,
        ..Evidence::default()
    };
    let [fn_mn, load_mn, fx_mn, fy_mn, ft_mn] = [i32::MIN; 5];
    let forces = Forces { fn_mn, load_mn, fx_mn, fy_mn, ft_mn, ratio_permille: Some(u16::MAX) };
    let slow = Slow {
        frame: u32::MAX,
        ticks: [longest; 25],
        mode: GripMode::Settle,
        forces: Some(forces),
        shear_mrad: Some(i16::MIN),
        s2_permille: u16::MAX,
        flexor_mv: Some(i16::MIN),
        extensor_mv: Some(i16::MIN),
        wearer_active: true,
        lesson: Some([Code::Minus; 2]),
        evidence: [(DetectorId::Injected, evidence); DETECTORS_MAX].into_iter().collect(),
        samples_sum: u32::MAX,
        line: Line::Armed { left_s: u8::MAX },
        behaviour: Some(Behaviour::Turn { by_ddeg: i16::MIN }),
    };
    let slow = length(&Up::Slow(slow));
    assert!(slow < FRAME_MAX, "{slow}");
    let bits_a_second = slow * 10 * 80;
    assert!(bits_a_second < 921_600 / 2, "slow frames may use at most half of the line: {bits_a_second}");
    let network = NetworkState {
        frame: u32::MAX,
        weights: [[i32::MIN; 24]; 2],
        activations: [i16::MIN; 24],
        updates: u32::MAX,
        teacher_age_ms: Some(u16::MAX),
        no_lesson: Some(NoLesson::Disturbed),
    };
    let setting = Setting { id: u8::MAX, value: i32::MIN };
    let identity = Identity { build: u64::MAX, chip: [u32::MAX; 3], reset: ResetCause::Other };
    let settings = [setting; SETTINGS_MAX].into_iter().collect();
    let about = About { identity, schema: u64::MAX, frames: u32::MAX, settings };
    let bytes = [u8::MAX; PIECE_MAX].into_iter().collect();
    let why = [u8::MAX; WHY_MAX].into_iter().collect();
    let last = Last { after: Some(Fault::TooManyRestarts), why, length: u16::MAX, from: u16::MAX, bytes };
    for fits in [
        answer(Answer::Network(network)),
        answer(Answer::Settings([setting; SETTINGS_PER_ANSWER].into_iter().collect())),
        answer(Answer::About(about)),
        answer(Answer::Last(last)),
        Up::Restored(Restored::of(Kept::Network, &[0; KEPT_MAX]).unwrap()),
    ] {
        length(&fits);
    }
    let senses = Senses { frame: u32::MAX, samples: [u16::MAX; COUNT], films: [u16::MAX; PVDF_COUNT] };
    let mut raw = Raw::default();
    raw.put(&Frame { sequence: u32::MAX, ..Frame::lost(0) });
    // In a slow frame: five messages of frames and one of readings leave a quarter of the line to everything else.
    let bytes = 5 * length(&Up::Raw(raw)) + length(&Up::Senses(senses));
    let part = bytes as f64 / f64::from(BAUD / 10 / 80);
    assert!(part < 0.78, "{bytes}: {part}");
    let counters = Counters { frames: u32::MAX, ..Counters::default() };
    assert!(encode(0, &Up::Counters(counters), &mut [0; 40]).is_some());
    assert!(encode(0, &Up::Counters(counters), &mut [0; 8]).is_none(), "too small a buffer is no panic");
}

/// Length of the longest frame of a message, bytes.
fn length(message: &Up) -> usize {
    encode(u16::MAX, message, &mut [0; FRAME_MAX]).expect("it fits a frame").len()
}
