//! The bytes of one message of each kind. If a line here must change, `wire::VERSION` must change with it: a monitor of
//! yesterday would read nonsense.

use tenax_hal_shim::channel::COUNT;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{
    ArrayVerdict, Counters, Down, Event, EventKind, FRAME_MAX, Forces, NetworkState, Receiver, Refusal,
    Setting, Slow, TickRecord, Up, VERSION, encode,
};
use tenax_hal_shim::words::{Capability, Cause, Code, DriveSource, Fault, GripMode, Kept, NoLesson, Reason};

fn check<T>(message: &T, golden: &str)
where
    T: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug,
{
    assert_eq!(VERSION, 2, "new version: write new golden bytes");
    let mut buffer = [0; FRAME_MAX];
    let bytes = encode(0x1234, message, &mut buffer).unwrap();
    let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(hex, golden, "{message:?}");
    let mut receiver = Receiver::new();
    let received = bytes.iter().find_map(|&byte| receiver.push::<T>(byte)).unwrap().unwrap();
    assert_eq!((received.sequence, &received.message), (0x1234, message));
}

#[test]
fn down() {
    check(&Down::Ping, "0402b42405fda0f2b800");
    check(
        &Down::Drive { drive: MotorDrive::Open(Duty::FULL), hold_ms: 200 },
        "0e02b4240102e807c801bd6b8d7200",
    );
    check(&Down::Set(Setting::S1Mv(100)), "0502b4240206643ae7467f00");
    check(&Down::Set(Setting::S2Permille(300)), "0c02b4240201ac0285269ef800");
    check(&Down::Set(Setting::MyoOnMv(160)), "0c02b4240202a0016a8664cf00");
    check(&Down::Set(Setting::ForceCeilingMn(40_000)), "0d02b4240203c0b802d5dbc85400");
    check(&Down::Stroke(true), "0a02b4240301d9f09c4d00");
    check(&Down::Zero, "0902b42404e4649fbf00");
    check(&Down::Samples, "0902b42405725498c800");
    check(&Down::Teach { codes: [Code::Minus, Code::Plus], age_ms: 40 }, "0502b424060702285483019d00");
    check(&Down::Network, "0902b424075e35962600");
    check(&Down::Forget, "0902b42408cf2829b600");
    check(&Down::Save, "0902b4240959182ec100");
    check(&Down::Set(Setting::NetworkSlipPermille(400)), "0c02b4240204900307ada1fa00");
}

#[test]
fn up() {
    check(&Up::Hello { frame_hz: 2_000, after: Some(Fault::WatchdogReset) }, "0402b42409d00f0105edcf792b00");
    let record = TickRecord {
        vibration: 500,
        s1: true,
        outputs: [-128, 64],
        slips: true,
        drive: MotorDrive::Close(Duty::FULL),
        source: DriveSource::Reflex,
    };
    let mut ticks = [TickRecord::default(); 25];
    ticks[24] = record;
    let forces = Forces { fn_mn: 4_000, fx_mn: -1_000, fy_mn: 20, ft_mn: 1_000, ratio_permille: Some(250) };
    let slow = Slow {
        frame: 49,
        ticks,
        mode: GripMode::Slip,
        forces: Some(forces),
        s2: false,
        s2_permille: 300,
        flexor_mv: Some(40),
        extensor_mv: None,
        wearer_active: false,
        lesson: Some([Code::Minus, Code::Plus]),
        array: ArrayVerdict { slip: true, confidence_permille: 870, age_ms: 0 },
        samples_sum: 0xDEAD_BEEF,
    };
    check(
        &Up::Slow(slow),
        "0602b4240131010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010117f4030180400101e807030301c03ecf0f28d00f01fa0105ac020150010201050201e6060aeffdb6f50d463442f600",
    );
    let mode = EventKind::Mode { from: GripMode::Watch, to: GripMode::Slip, cause: Cause::S1 };
    check(&Up::Event(Event { frame: 50, kind: mode }), "0602b424023208020304a3f05c1800");
    for (kind, golden) in [
        (Fault::SensorLost { channel: 38, reason: Reason::Dead }, "0702b4240232010226055657fa4c00"),
        (Fault::CapabilityLost(Capability::WearerIntent), "0d02b424023201020254fe189200"),
        (Fault::PressedAtBoot { channel: 24 }, "0d02b42402320107186bf30d1200"),
        (Fault::RecordDamaged(Kept::Zero), "0d02b42402320108016447fef100"),
        (Fault::StoreFull(Kept::Network), "0802b4240232010905b346e29f00"),
        (Fault::StoreFailed(Kept::Settings), "0d02b4240232010a025c74c15a00"),
    ] {
        check(&Up::Event(Event { frame: 50, kind: EventKind::Fault(kind) }), golden);
    }
    let stroke = EventKind::Stroke { mu_s_permille: 490, s2_permille: 392 };
    check(&Up::Event(Event { frame: 50, kind: stroke }), "0f02b424023202ea03880365fdf1fa00");
    check(&Up::Event(Event { frame: 50, kind: EventKind::EventsLost(3) }), "0c02b42402320303fced2b8000");
    check(
        &Up::Counters(Counters { frames: 100, ticks: 100, ..Counters::default() }),
        "0602b424036401026401010580ffd92e00",
    );
    check(&Up::Ack { of: 7, refused: Some(Refusal::Loaded) }, "0c02b42404070101f596d85b00");
    let network = NetworkState {
        frame: 74,
        weights: [[1; 24], [-(1 << 27); 24]],
        activations: [1 << 14; 24],
        updates: 1_000,
        teacher_age_ms: Some(40),
        no_lesson: Some(NoLesson::Late),
    };
    check(
        &Up::Network(network),
        "d002b424064a020202020202020202020202020202020202020202020202ffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7fffffff7f808002808002808002808002808002808002808002808002808002808002808002808002808002808002808002808002808002808002808002808002808002808002808002808002e807012801018c9526f100",
    );
    check(&Up::Saved { frame: 74, kept: Kept::Settings }, "0b02b424074a023346cad700");
    let mut samples = [8_190; COUNT];
    samples[0] = 1;
    check(
        &Up::Samples { frame: 74, samples },
        "5d02b424054a01fe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3f2f86c5ae00",
    );
}
