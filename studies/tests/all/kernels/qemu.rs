//! The kernels on two emulators that have nothing in common: QEMU's answers, memory and instructions are rigless'.

use std::path::Path;

use tenax_bench::board::emulated::kernels::{self, Kernels, Outcome, qemu};
use tenax_hal_shim::frame::Frame;
use tenax_logic::array::Reading;
use tenax_studies::chart::table::heard;

use super::{image, recordings};

/// What both say.
fn alike(image: &Path, recordings: &[Vec<Reading>], frames: &[Frame], kernels: Kernels) -> Outcome {
    let ours = kernels::run_frames(image, recordings, frames, kernels, &mut |_| {}).unwrap();
    let theirs = qemu::run_frames(image, recordings, frames, kernels).unwrap();
    assert_eq!(ours.answers, theirs.answers);
    for (ours, theirs) in ours.costs.iter().zip(&theirs.costs) {
        println!(
            "{:<24}{:>8} calls {:>9.1} instructions, QEMU {:.1}",
            ours.name,
            ours.calls,
            ours.mean(),
            theirs.mean()
        );
    }
    assert_eq!(ours.costs, theirs.costs);
    let differs = ours.ram.iter().zip(&theirs.ram).position(|(ours, theirs)| ours != theirs);
    assert_eq!((ours.ram.len(), differs), (theirs.ram.len(), None), "words of RAM");
    ours
}

#[test]
#[cfg_attr(not(qemu), ignore = "no qemu-system-arm when this was compiled")]
fn qemu_says_and_counts_what_rigless_does() {
    // Half as much again as the windows hold, of each.
    let recordings: Vec<_> = recordings().iter().map(|own| own[..own.len().min(60)].to_vec()).collect();
    let every = alike(image(), &recordings, &[], Kernels::All);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package is in the workspace");
    let frames = tenax_bench::image::build_frames(root).expect("the image");
    let signals = heard::sampled(1_250).unwrap();
    let others = alike(&frames, &[heard::readings(&signals)], &signals, Kernels::Detector);
    // Everything ran, or it would have been no test.
    let ran = |outcome: &Outcome| outcome.costs.len();
    assert_eq!((ran(&every), ran(&others)), (8, 12));
}
