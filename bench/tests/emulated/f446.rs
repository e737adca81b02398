//! The image for the STM32F446RE: the same decisions, and what it says of them on CAN.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use tenax_bench::board::Run;
use tenax_bench::board::agreement::Agreement;
use tenax_bench::board::emulated::{self, Mishap, Models, Options};
use tenax_bench::image::size::{FLASH_BYTES, Size};
use tenax_bench::image::{build_f446, panics, stack};
use tenax_bench::session::load_scene;
use tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME;
use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::words::Fault;
use tenax_palm::can::{Evidence, Margin, Word, unpack};
use tenax_scene::World;

use crate::{Rest, Swing};

fn image() -> &'static Path {
    static IMAGE: OnceLock<PathBuf> = OnceLock::new();
    IMAGE.get_or_init(|| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package is in the workspace");
        build_f446(root).expect("the image")
    })
}

fn picked_up(image: &Path, options: &Options) -> Run {
    let world = World::new(&load_scene("array-pick").expect("a scene"), 1);
    emulated::run(image, world, options, &mut |_| {}).expect("it runs").0
}

fn heard() -> &'static Run {
    static HEARD: OnceLock<Run> = OnceLock::new();
    HEARD.get_or_init(|| picked_up(image(), &Options::default()))
}

/// A picked-up object that slips: every tick as on the host, and each slow frame's evidence and margin on CAN are those that the host
/// finds in the same codes.
#[test]
fn it_decides_what_the_host_decides_and_says_so_on_can() {
    let run = heard();
    let (agreement, host) = Agreement::with_host(run);
    println!("{agreement}, {:?}", run.tick_cost);
    assert!(agreement.holds(), "{agreement}");
    let counters = run.counters;
    assert_eq!((counters.overruns, counters.frames_lost, counters.ticks_late), (0, 0, 0), "{counters:?}");
    assert_eq!((counters.telemetry_dropped, run.bad_frames, run.messages_missed), (0, 0, 0));

    let ticks = host.slip_and_warning.chunks_exact(FRAMES_PER_SLOW_FRAME.into());
    let expected = host.slows.iter().zip(ticks).flat_map(|(slow, ticks)| {
        let [slip, incipient] =
            [0, 1].map(|which| ticks.iter().fold(DetectorSet::NONE, |all, tick| all.or(tick[which])));
        let evidence = Evidence { frame: slow.frame, slip, incipient, wearer: slow.wearer_active };
        [Word::Evidence(evidence), Word::Margin(Margin::of(slow.forces, slow.s2_permille))]
    });
    let expected: Vec<Word> = expected.collect();
    let said: Vec<(u32, Word)> =
        run.can.iter().map(|frame| unpack(frame).expect("a fingertip's frame")).collect();
    // What came after the plant's last scan was no part of the run.
    assert!((2 * run.slows.len()..=2 * run.slows.len() + 2).contains(&said.len()), "{} frames", said.len());
    assert!(said.len() > 1_000 && run.can_given_up == 0, "{} frames", said.len());
    for (n, ((who, word), expected)) in said.iter().zip(&expected).enumerate() {
        assert_eq!((*who, word), (said[0].0, expected), "frame {n}");
    }
    let spoke = |word: &&Word| matches!(word, Word::Evidence(Evidence { slip, .. }) if !slip.is_empty());
    let warned =
        |word: &&Word| matches!(word, Word::Evidence(Evidence { incipient, .. }) if !incipient.is_empty());
    let held = |word: &&Word| matches!(word, Word::Margin(Margin { margin_mn: Some(_), .. }));
    let [spoke, warned, held] = [
        expected.iter().filter(spoke).count(),
        expected.iter().filter(warned).count(),
        expected.iter().filter(held).count(),
    ];
    println!(
        "{} frames on CAN, {spoke} with slip, {warned} with a warning, {held} with a margin",
        said.len()
    );
    assert!(spoke > 0 && warned > 0 && held > 100, "{spoke} {warned} {held}");
}

/// Nobody acknowledges: each frame is given up when the next is due, and the fingertip is none the wiser.
#[test]
fn a_bus_without_anybody_changes_nothing() {
    let (heard, alone) = (heard(), picked_up(image(), &Options { can_is_alone: true, ..Options::default() }));
    assert_eq!((alone.slows == heard.slows, alone.scans == heard.scans), (true, true));
    assert_eq!((&alone.drives, &alone.events, alone.counters.ticks_late), (&heard.drives, &heard.events, 0));
    assert_eq!(alone.can, []);
    assert!(alone.can_given_up as usize + 4 >= heard.can.len(), "{} given up", alone.can_given_up);
}

/// A port that acknowledges nothing, not even that it is set up, is left alone.
#[test]
fn a_dead_port_changes_nothing() {
    let options = Options { models: Models::Rigless, ..Options::default() };
    let run = emulated::run(image(), Swing::new(0.3), &options, &mut |_| {}).expect("it runs").0;
    let agreement = Agreement::of(&run);
    assert!(agreement.holds() && run.slows.len() == 24, "{agreement}");
    assert_eq!((run.can.len(), run.counters.ticks_late, run.counters.overruns), (0, 0, 0));
}

/// On its own oscillator the chip would disturb others.
#[test]
fn without_a_crystal_it_is_silent() {
    let options = Options { mishaps: vec![(0.2, Mishap::CrystalStops(false))], ..Options::default() };
    let run = emulated::run(image(), Rest::new(Swing::new(0.5)), &options, &mut |_| {}).expect("it runs").0;
    assert_eq!(run.starts, [None, Some(Fault::CrystalLost)]);
    assert!((26..=34).contains(&run.can.len()), "{} frames in 0.2 s", run.can.len());
}

/// In the F411's memory map, and no way to panic.
#[test]
fn it_fits_and_control_cannot_panic() {
    let [size, other] = [image(), super::image()].map(|image| Size::read(image).expect("a size"));
    println!("{size:?}, the F411's {other:?}, {:?}", panics::check(image()).expect("no panic in control"));
    assert!(size.flash <= FLASH_BYTES && size.flash < other.flash && size.ram < other.ram, "{size:?}");
    let bound = stack::Bound::of(image()).expect("a bound");
    assert!(bound.bytes < bound.free, "{} of {}", bound.bytes, bound.free);
}
