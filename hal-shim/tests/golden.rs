//! The bytes of one message of each kind. If a line here must change, `wire::VERSION` must change with it: a monitor of
//! yesterday would read nonsense.

use tenax_hal_shim::channel::COUNT;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{
    Counters, Down, Event, EventKind, FRAME_MAX, Forces, Receiver, Refusal, Setting, Slow, TickRecord, Up,
    VERSION, encode,
};
use tenax_hal_shim::words::{Capability, Cause, DriveSource, Fault, GripMode, Reason};

fn check<T>(message: &T, golden: &str)
where
    T: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug,
{
    assert_eq!(VERSION, 1, "new version: write new golden bytes");
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
    check(&Down::Ping, "0401b42405130f47aa00");
    check(
        &Down::Drive { drive: MotorDrive::Open(Duty::FULL), hold_ms: 200 },
        "0c01b4240102e807c8017857024b00",
    );
    check(&Down::Set(Setting::S1Mv(100)), "0501b4240206649495d2f900");
    check(&Down::Set(Setting::S2Permille(300)), "0c01b4240201ac02183c76c900");
    check(&Down::Set(Setting::MyoOnMv(160)), "0c01b4240202a001f79c8cfe00");
    check(&Down::Set(Setting::ForceCeilingMn(40_000)), "0d01b4240203c0b80236dc47da00");
    check(&Down::Stroke(true), "0a01b4240301098a3c0a00");
    check(&Down::Zero, "0901b424040acb2aad00");
    check(&Down::Samples, "0901b424059cfb2dda00");
}

#[test]
fn up() {
    check(&Up::Hello { frame_hz: 2_000, after: Some(Fault::WatchdogReset) }, "0401b42409d00f01050ec8f6a500");
    let record = TickRecord {
        vibration: 500,
        s1: true,
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
        samples_sum: 0xDEAD_BEEF,
    };
    check(
        &Up::Slow(slow),
        "0601b4240131010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010114f4030101e807030301c03ecf0f28d00f01fa0105ac020150010aeffdb6f50d3eff38ca00",
    );
    let mode = EventKind::Mode { from: GripMode::Watch, to: GripMode::Slip, cause: Cause::S1 };
    check(&Up::Event(Event { frame: 50, kind: mode }), "0601b42402320802030466ccd12100");
    for (kind, golden) in [
        (Fault::SensorLost { channel: 38, reason: Reason::Dead }, "0701b424023201022605936b777500"),
        (Fault::CapabilityLost(Capability::WearerIntent), "0d01b4240232010202b7f9971c00"),
        (Fault::PressedAtBoot { channel: 24 }, "0d01b424023201071888f4829c00"),
    ] {
        check(&Up::Event(Event { frame: 50, kind: EventKind::Fault(kind) }), golden);
    }
    let stroke = EventKind::Stroke { mu_s_permille: 490, s2_permille: 392 };
    check(&Up::Event(Event { frame: 50, kind: stroke }), "0f01b424023202ea0388036646c61100");
    check(&Up::Event(Event { frame: 50, kind: EventKind::EventsLost(3) }), "0c01b4240232030361f7c3b100");
    check(
        &Up::Counters(Counters { frames: 100, ticks: 100, ..Counters::default() }),
        "0601b424036401026401010581993bb700",
    );
    check(&Up::Ack { of: 7, refused: Some(Refusal::Loaded) }, "0c01b42404070101688c306a00");
    let mut samples = [8_190; COUNT];
    samples[0] = 1;
    check(
        &Up::Samples { frame: 74, samples },
        "5d01b424054a01fe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3ffe3f045e8a5600",
    );
}
