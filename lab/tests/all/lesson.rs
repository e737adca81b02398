//! A lesson on the emulated board, beside the same on the host.

use std::path::Path;

use tenax_hal_shim::channel::FRAME_HZ;
use tenax_lab::learn::chain::Chain;
use tenax_lab::learn::finger::Finger;
use tenax_lab::learn::trial::Setup;
use tenax_sim::board::agreement::Agreement;
use tenax_sim::board::simulated;
use tenax_sim::session::Board;

/// What `tenax learn` says of all its trials: the camera teaches over the line, and every weight is the host's.
#[test]
fn a_lesson_teaches_the_image_what_it_teaches_the_host() {
    let lesson = || Chain::new(vec![Setup::new(&Finger::plain(1), 7, true).expect("a lesson")]);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package is in the workspace");
    let board = Board::emulated(root).expect("the image");
    let (image, _) = board.run(lesson(), &mut |_| {}).expect("the run");
    let agreement = Agreement::of(&image);
    assert!(agreement.holds(), "{agreement}");
    let network = image.networks().next().expect("it was asked for");
    assert!(network.updates > 1_000, "{network:?}");
    // It is not the run that the host's own board makes of the lesson: there a command is taken in its own frame.
    let (host, _) = simulated::run(lesson(), &mut |_| {});
    let late = image.taken.iter().zip(&host.taken).filter(|(image, host)| image.0 > host.0).count();
    assert!(late > 0 && image.slows != host.slows);
    let latest = image.taken.iter().zip(&host.taken).map(|(image, host)| image.0 - host.0).max();
    assert!(latest <= Some(FRAME_HZ / 1_000), "{latest:?} ticks late");
}
