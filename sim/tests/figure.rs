//! The figure is drawn, whatever the run.

use tenax_sim::plot::draw;
use tenax_sim::session::{self, Board};

fn recording(csv: &str) -> tempfile::NamedTempFile {
    let file = tempfile::Builder::new().suffix(".csv").tempfile().unwrap();
    std::fs::write(file.path(), csv).unwrap();
    file
}

#[test]
fn a_run_is_drawn() {
    let file = recording("t,pvdf_1,fsr_a\n0,1.65,0.2\n0.5,1.8,0.9\n");
    let outcome = session::replay(file.path(), None, 1, &Board::Host, &mut |_| {}).unwrap();
    let svg = draw::svg(&outcome.figure).unwrap();
    for word in ["force, N", "Ft/Fn", "S1", "S2", "gate", "by the reflex", "time, s"] {
        assert!(svg.contains(word), "{word} is missing");
    }
}

#[test]
fn a_recording_of_two_rows_at_one_instant_is_drawn_too() {
    let file = recording("t,pvdf_1\n0,1.65\n0,1.7\n");
    let outcome = session::replay(file.path(), None, 1, &Board::Host, &mut |_| {}).unwrap();
    assert!(draw::svg(&outcome.figure).unwrap().ends_with("</svg>\n"));
}
