//! Thresholds suggested from recordings of scenes in which it is known what they should be.

use tenax_bench::board::Run;
use tenax_bench::session::{Board, load_scene};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::wire::{EventKind, TickRecord};
use tenax_logic::setting::SettingId;
use tenax_scene::{SceneFile, World};
use tenax_serial::suggest::{Suggestion, Suggestions};

use crate::serving::Serving;
use crate::tool::tenax;

fn scene(name: &str, more: &str) -> (Run, World) {
    let text =
        std::fs::read_to_string(format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let file = SceneFile::parse(&format!("{text}\n{more}"), name).unwrap();
    Board::Host.run(World::new(&file, 1), &mut |_| {}).unwrap()
}

fn suggested(run: &Run, id: SettingId) -> Suggestion {
    let Suggestions { all, missing } = Suggestions::of(&run.line);
    println!("{all:#?} {missing:#?}");
    all.into_iter().find(|suggestion| suggestion.id == id).unwrap_or_else(|| panic!("{missing:?}"))
}

fn said(run: &Run, set: fn(&TickRecord) -> DetectorSet) -> usize {
    run.slows.iter().flat_map(|slow| &slow.ticks).filter(|tick| set(tick).contains(DetectorId::S1)).count()
}

#[test]
fn s1_follows_the_noise_where_nothing_slips() {
    let quiet = |noise: &str| {
        let (run, _) = scene("explore-wood", &format!("[pvdf]\nnoise_mv = {noise}"));
        suggested(&run, SettingId::S1)
    };
    // So loud that the default is no bound, and not so loud that the range is.
    let (one, two) = (quiet("1.5"), quiet("2.1"));
    let ratio = f64::from(two.value) / f64::from(one.value);
    assert!((1.2..1.6).contains(&ratio), "{one:?} {two:?}");
    assert!(one.why.contains("of quiet"), "{one:?}");
}

#[test]
fn quiet_alone_never_lowers_s1() {
    let (run, _) = scene("glass-quiet", "");
    let Suggestions { all, missing } = Suggestions::of(&run.line);
    assert!(all.iter().all(|suggestion| suggestion.id != SettingId::S1), "{all:?}");
    assert!(missing.iter().any(|why| why.contains("let something slip")), "{missing:?}");
}

#[test]
fn the_suggested_s1_hears_the_slip_and_not_the_quiet() {
    let s1 = suggested(&scene("glass", "").0, SettingId::S1);
    let set = format!("[[command]]\nat_s = 0.5\nkind = \"set-s1-mv\"\nvalue = {}\n", s1.value);
    let (run, world) = scene("glass", &set);
    assert!(!world.truth().dropped && said(&run, |tick| tick.acted) > 0, "{s1:?}");
    let (run, _) = scene("glass-quiet", &set);
    assert_eq!(said(&run, |tick| tick.believed), 0, "{s1:?}");
}

#[test]
fn s2_is_what_strokes_measure() {
    let (run, _) = scene("explore-wood", "");
    let stroke = |kind: &EventKind| match kind {
        EventKind::Stroke { s2_permille, .. } => Some(i32::from(*s2_permille)),
        _ => None,
    };
    let measured: Vec<i32> = run.events.iter().filter_map(|event| stroke(&event.kind)).collect();
    let s2 = suggested(&run, SettingId::S2);
    let least = measured.iter().min().copied().expect("it strokes");
    // Higher than a person may choose where the line is not trusted; the stroke itself has set it.
    assert_eq!(s2.value, *SettingId::S2.row().range().end(), "{s2:?}");
    let wanted =
        s2.why.split(" would be outside").next().and_then(|why| why.rsplit(' ').next()?.parse().ok());
    let wanted: i32 = wanted.expect("what was measured");
    assert!((wanted - least).abs() * 10 < least, "{s2:?} {measured:?}");
    // On the board's scale of ratios: r / sqrt(1 + r^2), and 0.8 of it.
    let truth = 800.0 * 0.5 / f64::hypot(0.5, 1.0);
    assert!((f64::from(wanted) - truth).abs() < 0.1 * truth, "{s2:?} {truth}");
}

#[test]
fn a_muscles_level_is_between_rest_and_contraction() {
    // The scene: rest 50 mV with 8 mV of wandering, contractions of 400 to 900 mV.
    let (run, _) = scene("wearer", "");
    let on = suggested(&run, SettingId::EmgOn);
    assert!((100..300).contains(&on.value), "{on:?}");
}

#[test]
fn what_is_not_there_is_not_suggested() {
    let (run, _): (Run, World) =
        Board::Host.run(World::new(&load_scene("rig").unwrap(), 1), &mut |_| {}).unwrap();
    let Suggestions { missing, .. } = Suggestions::of(&run.line);
    assert!(missing.iter().any(|why| why.starts_with("emg-on-mv: ")), "{missing:?}");
    let nothing = Suggestions::of(&[]);
    assert_eq!((nothing.all.len(), nothing.missing.len()), (0, 3), "{nothing:?}");
}

#[test]
fn what_is_suggested_is_printed_with_its_reason_and_set() {
    let (run, _) = scene("glass", "");
    let s1 = suggested(&run, SettingId::S1);
    let mut served = Serving::trusting();
    let file = served.folder.path().join("glass.line.bin");
    std::fs::write(&file, &run.line).unwrap();
    let config = |args: &[&str]| {
        let (done, out, error) = tenax(&[&["config", "--port", &served.places[0]], args].concat());
        assert!(done, "{out}{error}");
        out
    };
    let out = config(&["suggest", file.to_str().unwrap(), "--write"]);
    let line = format!("tenax config set s1-mv={}    # {}\n", s1.value, s1.why);
    assert!(out.contains(&line) && out.contains(&format!("\ns1-mv = {}\n", s1.value)), "{out}");
    assert_eq!(config(&["get", "s1-mv"]), format!("{}\n", s1.value));
    served.kill();
}
