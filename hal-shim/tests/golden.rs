//! The bytes of one message of each kind, in `golden.txt` under the version that they belong to. If one changes, the
//! version must: a monitor of yesterday would read nonsense.
//!
//! After a new [`VERSION`], `TENAX_GOLDEN=write cargo test -p tenax-hal-shim --test golden` writes the file anew. While the
//! version is the file's own it refuses, unless nobody has that version yet: `TENAX_GOLDEN=unreleased`.

use std::fmt::Debug;
use std::fmt::Write as _;

use serde::Serialize;
use serde::de::DeserializeOwned;
use tenax_hal_shim::behaviour::{Behaviour, CameraView, Ending, MARKERS, UNTRACKED};
use tenax_hal_shim::channel::{COUNT, PVDF_COUNT, SAMPLE_MAX};
use tenax_hal_shim::detector::{DetectorHealth, DetectorId, DetectorSet, Direction, Evidence};
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{
    About, Answer, Counters, Down, Event, EventKind, FRAME_MAX, Forces, Identity, Last, NetworkState, Raw,
    Receiver, Refusal, ResetCause, Restored, Senses, Setting, Slow, TickRecord, Up, VERSION, encode,
};
use tenax_hal_shim::words::{
    Calibration, CalibrationRefusal, Capability, Cause, Code, Consent, DriveSource, Fault, GripMode, Kept,
    Line, NoLesson, Prompt, Reason,
};

/// Writes a message's line, and reads its bytes back.
fn line<T: Serialize + DeserializeOwned + PartialEq + Debug>(text: &mut String, message: &T) {
    let mut buffer = [0; FRAME_MAX];
    let bytes = encode(0x1234, message, &mut buffer).expect("it fits a frame");
    let mut receiver = Receiver::new();
    let received = bytes.iter().find_map(|&byte| receiver.push::<T>(byte)).expect("whole").expect("valid");
    assert_eq!((received.sequence, &received.message), (0x1234, message));
    let shown = format!("{message:?}");
    let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    writeln!(text, "{} {hex}", shown.split([' ', '(', '{']).next().unwrap_or_default()).expect("memory");
}

fn down() -> Vec<Down> {
    vec![
        Down::Ping,
        Down::Drive { drive: MotorDrive::Open(Duty::FULL), hold_ms: 200 },
        Down::Set(Setting { id: 4, value: 40_000 }),
        Down::Begin(Behaviour::Turn { by_ddeg: -200 }),
        Down::Zero,
        Down::Samples,
        Down::Teach { codes: [Code::Minus, Code::Plus], age_ms: 40 },
        Down::Network,
        Down::Forget,
        Down::Save,
        Down::Get(2),
        Down::Settings(17),
        Down::Hello,
        Down::Open { nonce: 0xDEAD_BEEF },
        Down::CalibrateEmg,
        Down::End,
        Down::View(CameraView {
            age_ms: 33,
            moving_e4: 20,
            angle_ddeg: Some(-15),
            normal: [UNTRACKED; MARKERS],
            shear: [-1; MARKERS],
        }),
        Down::About,
        Down::Stream { raw: true, senses: true, hold_s: 300 },
        Down::Last(512),
    ]
}

const WORKING: Evidence = Evidence {
    slip: false,
    incipient: false,
    confidence_permille: 0,
    direction: Direction::Unknown,
    decided_at: 0,
    health: DetectorHealth::Working,
    raw: 0,
};

fn slow() -> Slow {
    let record = TickRecord {
        vibration: 500,
        outputs: [-128, 64],
        said: DetectorSet::ALL,
        believed: DetectorSet::only(DetectorId::S1),
        acted: DetectorSet::only(DetectorId::S1),
        drive: MotorDrive::Close(Duty::FULL),
        source: DriveSource::Reflex,
    };
    let mut ticks = [TickRecord::default(); 25];
    ticks[24] = record;
    let forces = Forces {
        fn_mn: 4_000,
        load_mn: 3_900,
        fx_mn: -1_000,
        fy_mn: 20,
        ft_mn: 1_000,
        ratio_permille: Some(250),
    };
    Slow {
        frame: 49,
        ticks,
        mode: GripMode::Slip,
        forces: Some(forces),
        s2_permille: 300,
        flexor_mv: Some(40),
        extensor_mv: None,
        wearer_active: false,
        lesson: Some([Code::Minus, Code::Plus]),
        evidence: [
            (
                DetectorId::S1,
                Evidence { slip: true, confidence_permille: 910, decided_at: 49, raw: 500, ..WORKING },
            ),
            (
                DetectorId::Mlp,
                Evidence { direction: Direction::Down, decided_at: 38, raw: -70_000, ..WORKING },
            ),
        ]
        .into_iter()
        .collect(),
        samples_sum: 0xDEAD_BEEF,
        line: Line::Armed { left_s: 60 },
        behaviour: Some(Behaviour::GentleGrasp),
    }
}

fn answers() -> Vec<Answer> {
    let network = NetworkState {
        frame: 74,
        weights: [[1; 24], [-(1 << 27); 24]],
        activations: [1 << 14; 24],
        updates: 1_000,
        teacher_age_ms: Some(40),
        no_lesson: Some(NoLesson::Late),
    };
    let mut samples = [8_190; COUNT];
    samples[0] = 1;
    vec![
        Answer::Done,
        Answer::Refused(Refusal::OutOfRange { min: -1, max: 1_500 }),
        Answer::Refused(Refusal::Loaded),
        Answer::Refused(Refusal::SensorLost),
        Answer::Refused(Refusal::WearerActive),
        Answer::Refused(Refusal::UnknownSetting),
        Answer::Refused(Refusal::NotArmed),
        Answer::Refused(Refusal::NoSession),
        Answer::Refused(Refusal::Replayed),
        Answer::Refused(Refusal::HeldTooLong),
        Answer::Setting(Setting { id: 2, value: 300 }),
        Answer::Settings(
            [Setting { id: 28, value: 80 }, Setting { id: 29, value: 200 }].into_iter().collect(),
        ),
        Answer::Samples(samples),
        Answer::Network(network),
        Answer::Nonce(0xDEAD_BEEF),
        Answer::About(about()),
        Answer::Last(Last {
            after: Some(Fault::PanicReset),
            length: 49_000,
            from: 512,
            bytes: [1, 0, 2].into_iter().collect(),
        }),
    ]
}

fn about() -> About {
    let identity =
        Identity { build: 0x0123_4567_89AB_CDEF, chip: [1, 2 << 16, u32::MAX], reset: ResetCause::Watchdog };
    let settings = [Setting { id: 1, value: 100 }, Setting { id: 41, value: 1 }];
    About { identity, frames: 200, settings: settings.into_iter().collect() }
}

/// The sequence number and the samples of each frame in turn.
fn raw() -> Raw {
    let mut raw = Raw::default();
    for n in 0..5 {
        let sample = |channel: u16| 1_001 * n as u16 + 101 * channel;
        raw.put(&Frame {
            sequence: 45 + n,
            valid: n != 3,
            pvdf: core::array::from_fn(|channel| sample(channel as u16)),
            switch_a: sample(12),
            switch_b: SAMPLE_MAX,
        });
    }
    raw
}

fn up() -> Vec<Up> {
    let mut all = vec![
        Up::Hello { frame_hz: 2_000, after: Some(Fault::WatchdogReset) },
        Up::Slow(slow()),
        Up::Counters(Counters {
            frames: 100,
            ticks: 100,
            control_us_max: 61,
            control_permille: 74,
            ..Counters::default()
        }),
        Up::Saved { frame: 74, kept: Kept::Settings },
        Up::About(about()),
        Up::Restored(Restored::of(Kept::Zero, &[1, 2, 3, 4]).expect("it fits")),
        Up::Raw(raw()),
        Up::Senses(Senses { frame: 49, samples: [8_190; COUNT], films: [40; PVDF_COUNT] }),
        Up::Taken { before: 50, of: 7, command: Down::Zero },
    ];
    let events = [
        EventKind::Mode {
            from: GripMode::Watch,
            to: GripMode::Slip,
            cause: Cause::Slip(DetectorId::Hebbian),
        },
        EventKind::Fault(Fault::SensorLost { channel: 38, reason: Reason::Dead }),
        EventKind::Fault(Fault::CapabilityLost(Capability::WearerIntent)),
        EventKind::Fault(Fault::PressedAtBoot { channel: 24 }),
        EventKind::Fault(Fault::RecordDamaged(Kept::Zero)),
        EventKind::Fault(Fault::StoreFull(Kept::Network)),
        EventKind::Fault(Fault::StoreFailed(Kept::Settings)),
        EventKind::Stroke { mu_s_permille: 490, s2_permille: 392 },
        EventKind::EventsLost(3),
        EventKind::Armed(Consent::Muscles),
        EventKind::Disarmed,
        EventKind::LineTrusted(true),
        EventKind::Calibration(Calibration::Asks(Prompt::Open)),
        EventKind::Calibration(Calibration::Done { separation_permille: 5_900 }),
        EventKind::Calibration(Calibration::Refused(CalibrationRefusal::Damaged)),
        EventKind::Fault(Fault::SensorLost { channel: 39, reason: Reason::Endless }),
        EventKind::Fault(Fault::RecordDamaged(Kept::Emg)),
        EventKind::Behaviour(Behaviour::HandOver, None),
        EventKind::Behaviour(Behaviour::HandOver, Some(Ending::Done)),
        EventKind::NoWearer(true),
        EventKind::Fault(Fault::SupplySagged),
        EventKind::Fault(Fault::CrystalLost),
        EventKind::Fault(Fault::TooManyRestarts),
        EventKind::Fault(Fault::NeverUnloaded),
    ];
    all.extend(events.map(|kind| Up::Event(Event { frame: 50, kind })));
    all.extend(answers().into_iter().map(|answer| Up::Answer { of: 7, frame: 50, answer }));
    all
}

#[test]
fn the_bytes_of_every_message_are_those_of_this_version() {
    let mut text = format!("version {VERSION}\n");
    down().iter().for_each(|message| line(&mut text, message));
    up().iter().for_each(|message| line(&mut text, message));
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden.txt");
    let golden = std::fs::read_to_string(path).unwrap_or_default();
    let of_this_version = golden.lines().next() == text.lines().next();
    match std::env::var("TENAX_GOLDEN").as_deref() {
        Ok("write") if of_this_version && golden != text => {
            panic!("version {VERSION} has other bytes: give it a new number")
        }
        Ok("write" | "unreleased") => return std::fs::write(path, &text).expect("golden.txt can be written"),
        _ => {}
    }
    for (golden, now) in golden.lines().zip(text.lines()) {
        assert_eq!(golden, now, "a message changed: a new VERSION, then the command at the top of this file");
    }
    assert_eq!(golden.lines().count(), text.lines().count(), "a message came or went: as above");
}
