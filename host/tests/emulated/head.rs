//! A board that feels with a photoelastic head alone.

use tenax::board::Run;
use tenax::board::agreement::Agreement;
use tenax::board::emulated::Options;
use tenax::session::{self, Board};
use tenax_hal_shim::detector::DetectorId;

use crate::image;

#[test]
fn the_image_holds_a_pulled_block_with_it_as_the_host_would() {
    let file = session::load_scene("head-alone").unwrap();
    let board = Board::Emulated { image: image().to_owned(), options: Options::default() };
    let mut run = Run::default();
    let outcome = session::scene_with(&file, 1, &board, &mut run, &mut |_| {}).unwrap();
    let agreement = Agreement::of(&run);
    assert!(agreement.holds(), "{agreement}");
    assert_eq!(outcome.report.slip.dropped, Some(false));
    let slid_mm = outcome.report.slip.distance_mm.expect("it slipped");
    assert!((0.05..2.0).contains(&slid_mm), "{slid_mm} mm");
    let acts = |slow: &tenax_hal_shim::wire::Slow| {
        slow.ticks.iter().any(|tick| tick.acted.contains(DetectorId::Photoelastic))
    };
    assert!(run.slows.iter().any(acts), "the head's pulse");
}
