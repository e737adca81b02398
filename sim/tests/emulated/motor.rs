//! The real image stops a blocked motor as the host's logic does: `bench/tests/motor.rs` says when.

use tenax_hal_shim::wire::{Event, EventKind};
use tenax_hal_shim::words::MotorStop;
use tenax_scene::World;
use tenax_sim::board::agreement::Agreement;
use tenax_sim::board::emulated::{self, Mishap, Options};
use tenax_sim::board::simulated;
use tenax_sim::session;

use crate::{Rest, Swing, image, run};

fn stops(events: &[Event]) -> Vec<Option<MotorStop>> {
    let stop = |event: &Event| if let EventKind::Motor(stop) = event.kind { Some(stop) } else { None };
    events.iter().filter_map(stop).collect()
}

// Shows B9, B8.
#[test]
fn a_jammed_gear_stops_the_image_s_motor_bit_for_bit_as_the_hosts() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/jam.toml");
    let file = session::load_scene(path.to_str().expect("a path")).expect("a scene");
    let (run, _) =
        emulated::run(image(), World::new(&file, 1), &Options::default(), &mut |_| {}).expect("it runs");
    let agreement = Agreement::of(&run);
    assert!(agreement.holds(), "{agreement}");
    assert_eq!((run.counters.ticks_late, run.counters.frames_lost, run.bad_frames), (0, 0, 0));
    assert_eq!(
        stops(&run.events),
        [Some(MotorStop::ClosingStalled), None, Some(MotorStop::OpeningStalled), None]
    );
    let (host, _) = simulated::run(World::new(&file, 1), &mut |_| {});
    assert_eq!(stops(&host.events), stops(&run.events));
}

// Shows B9.
#[test]
fn a_bridge_that_reports_a_fault_is_told_until_it_is_well() {
    let mishaps = vec![(0.6, Mishap::BridgeIsOff(true)), (0.9, Mishap::BridgeIsOff(false))];
    let run = run(Rest::new(Swing::new(1.2)), &Options { mishaps, ..Options::default() });
    assert_eq!(stops(&run.events), [Some(MotorStop::BridgeOff), None]);
    let frames: Vec<u32> = run
        .events
        .iter()
        .filter(|event| matches!(event.kind, EventKind::Motor(_)))
        .map(|event| event.frame)
        .collect();
    // 0.6 s are 1200 frames; it is asked once a slow frame and told in the next.
    assert!((1_200..1_250).contains(&frames[0]) && (1_800..1_850).contains(&frames[1]), "{frames:?}");
    assert_eq!((run.counters.ticks_late, run.counters.frames_lost), (0, 0));
}
