//! Records of a fingertip across a power cut.

use tenax_hal_shim::channel::{FSR, FSR_COUNT};
use tenax_hal_shim::front_end::FSR_REST_MV;
use tenax_hal_shim::wire::{Down, EventKind};
use tenax_hal_shim::words::{Fault, Kept};
use tenax_host_tests::{Bench, set};
use tenax_logic::fingertip::Fingertip;
use tenax_logic::setting::SettingId;
use tenax_logic::store::keeper::Keeper;
use tenax_logic::store::record::{PAYLOAD_BYTES, Record};
use tenax_logic::store::{Erase, open};

use super::flash::TestFlash;

fn save_all(fingertip: &mut Fingertip, keeper: &mut Keeper, flash: &mut TestFlash) -> Vec<Kept> {
    let (mut log, _) = open(flash, Erase::Allowed);
    let save = |record: Record| {
        let mut buffer = [0; PAYLOAD_BYTES];
        let mut saving = log.begin(record.kept(), record.payload(&mut buffer)).expect("room");
        while !saving.step(flash).expect("a flash that works") {}
        record.kept()
    };
    std::iter::from_fn(|| fingertip.next_record(keeper)).map(save).collect()
}

fn booted(flash: &mut TestFlash) -> Fingertip {
    let (_, found) = open(flash, Erase::Allowed);
    let mut fingertip = Fingertip::trusting();
    let mut buffer = [0; PAYLOAD_BYTES];
    for kept in Kept::ALL {
        if let Some(payload) = found.read(flash, kept, &mut buffer) {
            fingertip.restore(kept, payload);
        }
    }
    fingertip
}

/// A finger whose force sensor is 30 mV off, which reads as a load.
fn off_zero(fingertip: Fingertip) -> Bench {
    let mut bench = Bench::of(fingertip, 3);
    bench.pins_mv[FSR..FSR + FSR_COUNT].fill(f64::from(FSR_REST_MV + 30));
    bench.run(1_000);
    bench
}

fn fn_mn(bench: &Bench) -> i32 {
    bench.slows.last().and_then(|slow| slow.forces).expect("forces").fn_mn
}

// Shows B4.
#[test]
fn zero_and_settings_survive_and_a_fingertip_without_them_differs() {
    let mut flash = TestFlash::blank(4_096);
    let mut bench = off_zero(Fingertip::trusting());
    let mut keeper = bench.fingertip.keeper();
    assert!(save_all(&mut bench.fingertip, &mut keeper, &mut flash).is_empty(), "nothing has changed yet");
    let untouched = fn_mn(&bench);
    assert!(untouched > 100, "{untouched} mN");
    bench.accepts(Down::Zero);
    bench.accepts(set(SettingId::S2, 420));
    assert_eq!(save_all(&mut bench.fingertip, &mut keeper, &mut flash), [Kept::Settings, Kept::Zero]);
    bench.accepts(Down::Forget);
    assert_eq!(save_all(&mut bench.fingertip, &mut keeper, &mut flash), [Kept::Network]);

    let after = off_zero(booted(&mut flash));
    assert!(fn_mn(&after) < untouched / 4, "{} mN after, {untouched} mN before", fn_mn(&after));
    assert_eq!(after.slows.last().map(|slow| slow.s2_permille), Some(420));
    let mut same = booted(&mut flash);
    assert_eq!(same.network().weights, [[0; 24]; 2]);
    let mut keeper = same.keeper();
    assert!(same.next_record(&mut keeper).is_none(), "what was restored need not be saved");
}

#[test]
fn a_record_of_something_else_is_told_and_changes_nothing() {
    let mut fingertip = Fingertip::trusting();
    let mut keeper = fingertip.keeper();
    for kept in Kept::ALL {
        fingertip.restore(kept, &[0xFF; 12]);
        let event = fingertip.next_event().expect("an event for each");
        assert_eq!(event.kind, EventKind::Fault(Fault::RecordDamaged(kept)));
    }
    assert!(fingertip.next_record(&mut keeper).is_none());
    assert_eq!(fingertip.config().get(SettingId::S2), 300);
}
