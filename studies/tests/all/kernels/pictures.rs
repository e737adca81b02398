//! A camera of 160 x 120 pixels: on the emulated core against this machine, what a picture takes there, and how well it sees.

use std::path::Path;

use tenax_bench::board::emulated::kernels::pictures::{self, Picture};
use tenax_scene::picture::{HEIGHT, Options, Session, Truth, WIDTH};
use tenax_studies::vision::scored::{AFTER, SLIPS_PX, moved};
use tenax_vision_quarter::frame::{self, Frame};
use tenax_vision_quarter::object::Config;
use tenax_vision_quarter::{Camera, Summary};

/// Pictures: the object comes, is gripped, sheared, slides once, and the hand moves.
const PICTURES: usize = 130;

/// A drawn session, each picture the mean of every four pixels.
fn drawn(seed: u64) -> Vec<(Picture, Truth)> {
    let mut session = Session::new(Options { seed, rate_hz: 30.0, fisheye: true });
    let mut planes = vec![0; 3 * WIDTH * HEIGHT];
    let mut pictures = Vec::new();
    while let Some(truth) = session.picture(&mut planes) {
        let level = |at: usize| u16::from(planes[at]);
        let mean =
            |at: usize| (level(at) + level(at + 1) + level(at + WIDTH) + level(at + WIDTH + 1) + 2) / 4;
        let rows = (0..3 * HEIGHT).step_by(2);
        let places = rows.flat_map(|y| (0..WIDTH).step_by(2).map(move |x| y * WIDTH + x));
        let gbrp = places.map(|at| mean(at) as u8).collect();
        let taken_ms = (truth.t_s * 1e3) as u32;
        pictures.push((Picture { gbrp, taken_ms, learn: !truth.gripped }, truth));
    }
    pictures
}

fn take(camera: &mut Camera, picture: &Picture) -> Summary {
    let frame = Frame::from_gbrp(&picture.gbrp).unwrap();
    camera.picture(&frame, picture.learn, picture.taken_ms, picture.taken_ms)
}

#[test]
fn a_small_camera_sees_on_the_core_what_it_sees_here() {
    assert_eq!((frame::WIDTH, frame::HEIGHT), (160, 120));
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package is in the workspace");
    let image = tenax_bench::image::build_pictures(root).unwrap();
    println!("seed 901");
    let drawn: Vec<Picture> = drawn(901).into_iter().map(|(picture, _)| picture).take(PICTURES).collect();
    let outcome = pictures::run(&image, drawn.clone()).unwrap();
    assert_eq!(outcome.said.len(), drawn.len());
    let mut camera = Camera::new(Config::default());
    let (mut held, mut slips) = (0, 0);
    for (n, (picture, said)) in drawn.iter().zip(&outcome.said).enumerate() {
        let summary = take(&mut camera, picture);
        assert_eq!(*said, format!("{summary:?}"), "picture {n}");
        held += u32::from(summary.object.is_some());
        slips += u32::from(summary.slips());
    }
    // Something was seen, or it would have been no test.
    assert!(camera.markers().is_some_and(|markers| markers.len() > 5) && held > 40 && slips > 3);
    for cost in &outcome.costs {
        println!("{:<12}{:>10.0} mean{:>10} most{:>5} calls", cost.name, cost.mean(), cost.most, cost.calls);
    }
    let [heap, variables, stack] = outcome.ram;
    println!("RAM: heap {heap}, variables {variables}, stack {stack}");
    // Twenty pictures a second of the 216 M instructions that the slower chips with a camera port execute.
    let most = outcome.costs.iter().find(|cost| cost.name == "picture").expect("it ran").most;
    assert!(most < 10_800_000, "{most}");
}

/// Prints what it sees of whole sessions; `TENAX_SEEDS=10` is those of docs/vision.md.
#[test]
fn a_small_camera_sees_most_of_what_a_large_one_does() {
    let seeds = crate::seeds(3) as usize;
    let (mut markers, mut seen, mut recall, mut wrong) = ([0; 2], [0; 2], [0; 2], [0; 2]);
    for seed in (901..).take(seeds) {
        let mut camera = Camera::new(Config::default());
        let (mut before, mut since_slip, mut count) = (None, AFTER, 0);
        for (picture, truth) in drawn(seed) {
            let summary = take(&mut camera, &picture);
            let px = before.map_or(0.0, |before| moved(&before, &truth.state));
            since_slip = if px > SLIPS_PX / 6.0 { 0 } else { since_slip + 1 };
            (before, count) = (Some(truth.state), truth.markers.len());
            if truth.gripped {
                let add =
                    |share: &mut [u32; 2], yes: bool| *share = [share[0] + u32::from(yes), share[1] + 1];
                add(&mut seen, summary.object.is_some());
                if px > SLIPS_PX {
                    add(&mut recall, summary.slips());
                } else if since_slip > AFTER {
                    add(&mut wrong, summary.slips());
                }
            }
        }
        markers = [markers[0] + camera.markers().map_or(0, |markers| markers.len()), markers[1] + count];
    }
    println!(
        "{seeds} seeds from 901 on: markers {markers:?}, held seen {seen:?}, slip {recall:?}, false {wrong:?}"
    );
    assert!(10 * seen[0] > 9 * seen[1] && 2 * recall[0] > recall[1] && 20 * wrong[0] < wrong[1]);
}
